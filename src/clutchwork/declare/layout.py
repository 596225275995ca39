"""The layout of a System in bytes and the codes of the core: the single truth for Python and C++.

Standard library only: the build imports it and writes the C++ side from it.
"""

from __future__ import annotations

from functools import cache

# up to so many speeds nothing is left out of a matrix
FEW_SPEEDS = 12
# up to so many, steps of one length are taken: their matrices are whole
MOST_FIXED_SPEEDS = 64

# sizes of a system, in the order in which they stand in the header; the rooms are what a run needs at most for its own
# matrices without their zeros, whatever its contacts do, and 0 for few speeds: docs/theory/reduction.md
COUNTS = (
    ("nodes", "shafts and masses, the housing not counted"),
    ("speeds", "independent speeds v"),
    ("prescribed", "shafts whose speed is prescribed"),
    ("elements", "ways of torque elements, most of which have one"),
    ("contacts", "friction contacts"),
    ("transmissions", "elements whose two ways a varying ratio ties together"),
    ("states", "continuous states of elements and friction laws, then the shared ones"),
    ("shared", "states that any component may read, the last of the states"),
    ("flows", "flows between shared states"),
    ("processes", "components that only have shared states"),
    ("heats", "paths of the heat of a direction to a shared state"),
    ("draws", "inputs of processes that draw a flow from the process that gives them"),
    ("supplies", "elements that draw work and heat from a supply"),
    ("meters", "rigid lines whose energy is integrated"),
    ("meter_entries", "shares of accelerations and torques in the torques of rigid lines"),
    ("inputs", "signals"),
    ("segments", "segments of all signals"),
    ("params", "numbers in the parameter pool"),
    ("points", "points in the curve pool"),
    (
        "input_refs",
        "references from components to signals, shared states, rates, heats, supplied powers and sums of flows",
    ),
    ("basis_entries", "shares of speeds in node speeds that are not zero"),
    ("mass_entries", "entries of the mass matrix that are not zero"),
    ("element_rate_entries", "shares of speeds in the rates of elements that are not zero"),
    ("contact_rate_entries", "shares of speeds in the slips of contacts that are not zero"),
    ("factor_room", "room for the factor of the mass matrix"),
    ("direction_room", "room for the mass-weighted directions"),
    ("mobility_room", "room for the mobility of the contacts"),
    ("expansion_room", "room for the speeds over the reduced ones"),
    ("rate_room", "room for the rates over the reduced speeds"),
    ("mass_room", "room for the reduced mass matrix"),
    ("envelope_room", "room for the factor of the reduced motion"),
    ("spares", "locked contacts that can depend on others, at most"),
    ("set_size", "contacts of the largest set that depend on each other"),
    ("loads", "contacts whose capacity follows the torque of a gear row"),
)

# (name, type, shape, meaning); directions are those of the elements, then those of the contacts
FIELDS = (
    ("basis_end", "i4", ("nodes",), "end of each row of the next two"),
    ("basis_column", "i4", ("basis_entries",), "speeds, ascending in each row"),
    ("basis_value", "f8", ("basis_entries",), "node speeds w = basis v + basis_prescribed u"),
    ("basis_prescribed", "f8", ("nodes", "prescribed"), "share of the prescribed speeds in the node speeds"),
    ("inertia", "f8", ("nodes",), "inertia [kg m2] or mass [kg] of each node"),
    ("mass_end", "i4", ("speeds",), "end of each row of the next two"),
    ("mass_column", "i4", ("mass_entries",), "speeds, ascending in each row"),
    ("mass_value", "f8", ("mass_entries",), "M = basis' diag(inertia) basis; no entry for a massless coordinate"),
    ("mass_prescribed", "f8", ("speeds", "prescribed"), "basis' diag(inertia) basis_prescribed"),
    ("massless", "i4", ("speeds",), "1 where the speed is algebraic"),
    ("element_rate_end", "i4", ("elements",), "end of each row of the next two"),
    ("element_rate_column", "i4", ("element_rate_entries",), "speeds, ascending in each row"),
    ("element_rate_value", "f8", ("element_rate_entries",), "rate of each element per independent speed"),
    ("element_rate_prescribed", "f8", ("elements", "prescribed"), "rate per prescribed speed"),
    ("full", "i4", (1,), "1: it runs in the full form, which elements of several ways need"),
    ("element_way", "i4", ("elements",), "which way of its element: 0 the first or only one; others follow it"),
    ("element_kind", "i4", ("elements",), "number of the kind among the torque elements"),
    ("element_param", "i4", ("elements",), "offset into params"),
    ("element_state", "i4", ("elements",), "offset into states"),
    ("element_input", "i4", ("elements",), "offset into input_refs"),
    ("transmission_element", "i4", ("transmissions",), "its first way; the second one follows"),
    (
        "transmission_speed",
        "i4",
        ("transmissions",),
        "independent speed without inertia that follows from it, -1: none; each needs those before it alone",
    ),
    ("contact_rate_end", "i4", ("contacts",), "end of each row of the next two"),
    ("contact_rate_column", "i4", ("contact_rate_entries",), "speeds, ascending in each row"),
    ("contact_rate_value", "f8", ("contact_rate_entries",), "slip of each contact per independent speed"),
    ("contact_rate_prescribed", "f8", ("contacts", "prescribed"), "slip per prescribed speed"),
    ("contact_kind", "i4", ("contacts",), "number of the kind among the contacts"),
    ("contact_param", "i4", ("contacts",), "offset into params"),
    ("contact_input", "i4", ("contacts",), "offset into input_refs"),
    ("contact_law", "i4", ("contacts",), "number of the friction law"),
    ("contact_law_param", "i4", ("contacts",), "offset of the law's parameters into params"),
    ("contact_law_input", "i4", ("contacts",), "offset of the law's inputs into input_refs"),
    ("contact_state", "i4", ("contacts",), "offset of the law's states into states"),
    ("contact_tolerance", "f8", ("contacts",), "slip [rad/s] below which it may lock; 0: exact zero crossing"),
    ("contact_initial", "i4", ("contacts",), "0: decided by slip and load, 1: locked at the start"),
    ("contact_place", "i4", ("contacts",), "torque element whose state is the position of a stop, -1: it is none"),
    ("load_contact", "i4", ("loads",), "contact that follows the torque of its gear row"),
    ("load_motion", "f8", ("loads", "nodes"), "speeds in a virtual motion in which that row alone is violated, by one"),
    ("load_element_rate", "f8", ("loads", "elements"), "rate of each element in it"),
    ("load_contact_rate", "f8", ("loads", "contacts"), "slip of each contact in it"),
    ("flow_kind", "i4", ("flows",), "number of the kind among the flows"),
    ("flow_param", "i4", ("flows",), "offset into params"),
    ("flow_input", "i4", ("flows",), "offset into input_refs"),
    ("flow_from", "i4", ("flows",), "shared state that the flow leaves, -1: none"),
    ("flow_to", "i4", ("flows",), "shared state that the flow enters, -1: none"),
    ("process_kind", "i4", ("processes",), "number of the kind among the processes"),
    ("process_param", "i4", ("processes",), "offset into params"),
    ("process_input", "i4", ("processes",), "offset into input_refs"),
    ("process_state", "i4", ("processes",), "its first state among all states"),
    ("process_begins", "i4", ("processes",), "input whose value that state has at a start later than 0, -1: none"),
    ("heat_direction", "i4", ("heats",), "direction whose heat it is"),
    ("heat_to", "i4", ("heats",), "shared state that takes it"),
    ("heat_share", "f8", ("heats",), "share of it"),
    ("draw_process", "i4", ("draws",), "process that draws; those of one stand together"),
    ("draw_input", "i4", ("draws",), "which of its inputs draws"),
    ("draw_from", "i4", ("draws",), "process that gathers, from which it draws"),
    ("supply_element", "i4", ("supplies",), "element that draws its work and its heat"),
    ("meter_node", "i4", ("meters",), "node at which energy is counted"),
    ("meter_end", "i4", ("meters",), "end of each row of the next two"),
    ("meter_column", "i4", ("meter_entries",), "node of an acceleration; from `nodes` on a direction"),
    ("meter_value", "f8", ("meter_entries",), "share of it in the torque on that node"),
    ("shared_scale", "f8", ("shared",), "a shared state as an input is offset + scale * state"),
    ("shared_offset", "f8", ("shared",), "offset of that"),
    ("prescribed_input", "i4", ("prescribed",), "signal that gives the prescribed speed"),
    ("prescribed_sums", "i4", ("prescribed",), "1: an integral, which begins where a run does"),
    (
        "input_refs",
        "i4",
        ("input_refs",),
        "a signal; from `inputs` on a shared state; then the rate of a direction; then the heat of a direction [W];"
        " then what it draws from its supply [W]; then the sum of the flows into a process",
    ),
    ("input_first", "i4", ("inputs",), "first segment of each signal"),
    ("input_count", "i4", ("inputs",), "number of segments; 0: set from outside, held constant"),
    ("input_period", "f8", ("inputs",), "period [s] with which the segments repeat, 0: never"),
    ("input_value", "f8", ("inputs",), "initial value of a signal that is set from outside"),
    ("segment_time", "f8", ("segments",), "start of each segment [s]; before: the first, the last where they repeat"),
    (
        "segment_coef",
        "f8",
        ("segments", 12),
        "c0..c3, then amplitude, omega, phase, decay of two waves: with s = t - start,"
        " c0 + c1 s + c2 s^2 + c3 s^3, and amplitude exp(-decay s) sin(omega s + phase) of each wave",
    ),
    ("params", "f8", ("params",), "parameters of all components; a curve is (first point, number of points)"),
    ("points", "f8", ("points", 3), "x, y, slope to the next point"),
    ("initial_speed", "f8", ("speeds",), "v at the start"),
    ("initial_by_prescribed", "f8", ("speeds", "prescribed"), "v at a later start per change of a prescribed speed"),
    ("initial_by_ratio", "f8", ("speeds", "transmissions"), "the same per rate by which a transmission misses its row"),
    ("initial_angle", "f8", ("nodes",), "angle [rad] or position [m] at the start"),
    ("initial_state", "f8", ("states",), "states at the start"),
)

# matrices that stand there by rows, without their zeros: their columns are the speeds
SPARSE = ("basis", "mass", "element_rate", "contact_rate")

# what one row of the output holds, in order: (name, size)
ROW = (
    ("speed", "nodes"),
    ("angle", "nodes"),
    ("acceleration", "nodes"),
    ("state", "states"),
    ("element_torque", "elements"),
    ("contact_torque", "contacts"),
    ("element_work", "elements"),
    ("contact_work", "contacts"),
    ("contact_mode", "contacts"),
    ("contact_capacity", "contacts"),
    ("flow", "flows"),
    ("prescribed_work", "prescribed"),
    ("supply_power", "supplies"),
    ("supply_energy", "supplies"),
    ("meter_energy", "meters"),
    ("input", "inputs"),
)

# one event, in order
EVENT = (
    ("time", "s"),
    ("contact", "index"),
    ("from", "mode"),
    ("to", "mode"),
    ("cause", "code"),
    ("slip_acceleration", "rad/s2"),
    ("torque_before", "N m"),
    ("torque_after", "N m"),
    ("energy_before", "J"),
    ("energy_after", "J"),
)

# how a contact is, by number
MODES = {-1: "backward", 0: "locked", 1: "forward", 2: "open"}

# what led to an event, by number: (word, meaning); a number keeps its meaning, so that recorded events stay readable
CAUSES = {
    1: ("slip zero", "the slip reached zero"),
    2: ("torque limit", "a locked contact reached its static capacity"),
    3: ("input", "a signal has a knot there, which made the contact lock or let go"),
    4: ("other event", "another contact changed at this instant, and this one had to follow"),
    5: ("impulse", "speeds jumped"),
    7: ("passing", "the slip of an open contact passed zero: nothing changes but the direction"),
    8: ("fault", "a fault of the contact was triggered; it stays for the rest of the run"),
    9: ("jam", "no torque balanced the friction of a gear, so that it stopped at once"),
    10: ("impact", "the gap of a stop closed: it bounced, or holds"),
}

# integrators by name, with their numbers in the core; auto chooses between those with steps of any length
METHODS = {"auto": 0, "rodas5p": 1, "dopri5": 2, "fixed": 3}

# what the method "fixed" does not take, by number: (name, what it is); a number keeps its meaning
REFUSALS = {
    1: ("varying_ratio", "its ratio varies"),
    4: ("chatters", "its law jumps with the sign of the slip and never sticks"),
    5: ("many_speeds", f"the model has more than {MOST_FIXED_SPEEDS} independent speeds"),
    6: ("bristles", "its bristles or teeth move within any step"),
    7: ("flows", "pressures of its oil change within any step"),
    8: ("single_stops", "an impact of a stop needs double precision"),
    9: ("single_loads", "friction that follows a load needs double precision"),
    10: ("single_waves", "a sine over a long time needs double precision"),
    11: ("single_prescribed", "a prescribed speed needs double precision"),
}

# what a run counts, in order: (name, meaning)
STATISTICS = (
    ("steps", "accepted steps"),
    ("rejected", "steps that were taken again with a smaller size"),
    ("evaluations", "evaluations of the motion"),
    ("jacobians", "evaluations of its derivatives"),
    ("events", "events"),
    ("phases", "smooth phases between them"),
    ("locations", "searches for the instant of an event"),
)

# why a run returned: (name, message, remedy)
STATUS = (
    ("done", "reached the end time", ""),
    ("rows_full", "the output buffer is full", "continue with a new buffer"),
    ("events_full", "the event buffer is full", "drain the events and continue"),
    ("step_collapse", "the step size collapsed", "look for a discontinuous signal or loosen the tolerances"),
    ("not_finite", "a value is not finite", "check the parameters and signals of what is named"),
    ("too_many_steps", "the budget of steps is spent", "raise max_steps or shorten the run"),
    ("too_many_events", "the budget of events is spent", "raise max_events or shorten the run"),
    (
        "chatter",
        "the torque jumps with the sign of the slip again and again, the contact cannot come to rest",
        "give it a law that sticks, such as coulomb or stribeck, or one with states, such as lugre",
    ),
    (
        "out_of_table",
        "a table is left whose extrapolation is an error",
        "extend the table, or choose the extrapolation linear or nearest",
    ),
    ("fault", "a fault was triggered that is reported as an error", "report it as a warning to go on"),
    (
        "zeno",
        "more than 50 events within a microsecond",
        "give the shafts beside the named element inertia, or damping to the springs that drive it",
    ),
    (
        "no_mode",
        "no set of sticking contacts fits",
        "look for inertias that differ by more than twelve orders of magnitude",
    ),
    ("bad_system", "the system bytes do not fit this core", "assemble the driveline again with this version"),
    (
        "jammed",
        "prescribed speeds or ratios turn a freewheel backward or go beyond a stop, they or initial speeds break the "
        "ratio of a transmission, or a ratio is zero before a shaft without inertia",
        "prescribe speeds that it allows, or put a shaft with inertia and a spring in between",
    ),
    (
        "unbalanced",
        "no torques fit the friction that follows loads",
        "give a named gear more efficiency, or the shafts that drive it more inertia",
    ),
    ("interrupted", "the run was interrupted", "what was computed up to here is kept in .trajectory"),
    (
        "refused",
        "steps of one length do not take the motion",
        "choose the method auto, or model it otherwise: the guide on fixed steps lists what they take",
    ),
)
# the numbers of these
STATUSES = [name for name, *_ in STATUS]
DONE, ROWS_FULL, EVENTS_FULL, NOT_FINITE, INTERRUPTED, REFUSED = (
    STATUSES.index(name) for name in ("done", "rows_full", "events_full", "not_finite", "interrupted", "refused")
)


@cache
def layout_text() -> str:
    """Fingerprint text of the layout."""
    named = ([name for name, *_ in table] for table in (STATUS, STATISTICS))
    return repr(
        (FEW_SPEEDS, COUNTS, FIELDS, ROW, EVENT, MODES, {n: word for n, (word, _) in CAUSES.items()}, METHODS, *named)
    )
