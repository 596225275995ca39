"""What a shift shows of the pistons of its elements, learnt for the next one. docs/theory/shifts.md (18), (26)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from clutchwork.shifts.parallel import JOLT, USUAL

if TYPE_CHECKING:
    from clutchwork.shifts.parallel import ParallelSequence

# change of the fill time per jolt [s/rad], per share of it that an element was late, and at most
PER_JOLT, PER_LATE, MOST = 0.04, 0.3, 0.08
# share of what a shift shows of the kiss point that is learnt, and at most of the range of commands
PER_KISS, MOST_KISS = 0.6, 0.03
# looks at an inertia phase that make a mean
LOOKS = 5


def adapt(course: ParallelSequence) -> None:
    """Fill times and kiss points as a shift has shown them."""
    _adapt_fill_times(course)
    _adapt_kiss_points(course)


def _adapt_fill_times(course: ParallelSequence) -> None:
    """Longer filling of those that closed too late, shorter of those that gripped while they were filled.

    Late are elements for which the torque phase had to wait, for the input ran away meanwhile. Where nothing took the
    torque over before speeds changed nothing is seen.
    """
    early = course.jolt > JOLT
    for name in course.one.on if early else course.takes:
        driver = course.do.drivers.get(name)
        if driver is None:
            continue
        late = max(0.0, course.late - USUAL) / max(driver.fill_time, USUAL)
        change = -min(MOST, PER_JOLT * course.jolt) if early else min(MOST, PER_LATE * late)
        driver.fill_time *= 1.0 + course.with_.adaptation * change


def _adapt_kiss_points(course: ParallelSequence) -> None:
    """Further where the loop had to add torque in the inertia phase, nearer where it had to take some away."""
    for name, missed in course.missed.items():
        driver = course.do.drivers.get(name)
        if driver is None or missed.looks < LOOKS:
            continue
        of = driver.of
        seen = of.command(missed.torque) - of.command(max(0.0, missed.torque - missed.added))
        most = MOST_KISS * abs(of.commands[-1] - of.commands[0])
        driver.kiss += course.with_.adaptation * min(most, max(-most, PER_KISS * seen))
