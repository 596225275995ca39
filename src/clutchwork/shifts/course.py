"""One exchange while it goes on: its states, and what they ask of the elements. docs/theory/shifts.md (7)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from clutchwork.shifts.actuation import ENGAGED
from clutchwork.shifts.profile import Profile, share_of

if TYPE_CHECKING:
    from clutchwork.shifts.actuation import Actuation
    from clutchwork.shifts.exchange import Exchange
    from clutchwork.shifts.record import Measured
    from clutchwork.shifts.settings import ShiftSettings

# how far above its launch speed an engine without load comes [rad/s]
RUN_UP = 20.0
# torque at the input below which a dog clutch counts as unloaded [N m]
UNLOADED = 5.0


@dataclass
class ExchangeSequence:
    """One exchange that goes on; each state is a method that returns the next one, or nothing while it lasts."""

    one: Exchange
    with_: ShiftSettings
    do: Actuation
    since: float  # s, begin of the state
    filled: bool = False  # whether the one that closes was filled in the exchange before
    ahead: str = ""  # the one that closes in the exchange that follows, if one does
    opens: tuple[str, ...] = ()  # what opens at once
    state: str = "mesh"
    torque_factor: float = 1.0  # what the engine is asked for
    blip: float = 0.0  # throttle on top of that of the driver
    _closing: tuple[str, ...] = ()  # elements that close beside `on`
    _fill_time: float = 0.0  # s
    _loaded: float = 0.0  # N m, at the input where the torque phase began

    def __post_init__(self) -> None:
        self._profile = Profile(self.one, self.with_, self.do.is_dog(self.one.on))

    def torque_change(self, now: Measured) -> float:
        """Torque requested at the input on top of the driver's [N m]."""
        return (self.torque_factor - 1.0) * (self._loaded if now.demand is None else now.demand)

    def step(self, time: float, period: float, now: Measured) -> str:
        """Do what the state asks for; the state that begins, if one does. "done": the exchange is made."""
        new: str = getattr(self, self.state)(time - self.since, period, now)
        if new == "fill":
            self.state, self.since = new, time
            new = self.fill(0.0, period, now) or new
        if new and new != self.state:
            self.state, self.since = new, time
        if new in ("torque", "inertia"):
            self._loaded, self.torque_factor = now.input_torque, 1.0
            self._profile.begin(now)
        return new

    # ------------------------------------------------------------------------------------------------------ states

    def mesh(self, passed: float, _: float, now: Measured) -> str:
        """Dog clutches of the gear that stand still go in before anything turns; then what neither opens nor closes.

        A synchroniser brings its shaft to speed before.
        """
        one, with_, do = self.one, self.with_, self.do
        self._keep_down(now)
        out = [name for name in one.kept if do.is_dog(name) and not do.engage(name, now)]
        if passed < with_.fill_time and any(abs(now.slips[name]) < with_.dog_slip for name in out):
            return ""
        if passed < with_.longest and any(name in do.rivals for name in out):
            return ""
        do.open(*self.opens)
        # what was closed stays so; what closes beside `on` stops its members softly while that is filled
        self._closing = tuple(name for name in one.kept if do.slides(name) and not do.commands[name])
        do.close((name for name in one.kept if name not in self._closing), with_)
        return "fill"

    def fill(self, passed: float, _: float, now: Measured) -> str:
        """The one that closes up to where it touches, the other down to what it carries."""
        one, with_, do = self.one, self.with_, self.do
        self._keep_down(now)
        takes = not self.filled and (do.slides(one.on) or do.slides(one.off))
        self._fill_time = self._fill_time or do.fill_time([one.on], with_)
        share = share_of(passed, self._fill_time if takes else 0.0)
        do.carry(one.on, 0.0, with_)
        do.commands.update(dict.fromkeys(self._closing, share * share * with_.full_pressure))
        if do.slides(one.off):
            full = with_.full_pressure
            held = do.pressure(one.off, with_.margin * abs(one.off_torque * now.input_torque), with_)
            do.commands[one.off] = held + (1.0 - share) * (full - held)
        if share < 1.0:
            return ""
        if self._takes_over(now) or do.is_dog(one.off):
            return "torque"
        do.open(*([one.off] if one.off and not do.slides(one.off) else []))
        return "inertia"

    def torque(self, passed: float, _: float, now: Measured) -> str:
        """One takes over from the other; a dog clutch that nothing can take over from is unloaded by the engine."""
        one, with_, do = self.one, self.with_, self.do
        if do.is_dog(one.off) and not self._takes_over(now):
            return self._unload(passed, now)
        share, torque = share_of(passed, with_.torque_time), abs(now.input_torque)
        do.carry(one.on, share * abs(one.on_torque) * torque, with_)
        do.carry(one.off, (1.0 - share) * with_.margin * abs(one.off_torque) * torque, with_)
        if share < 1.0 and abs(now.slips[one.off]) <= with_.sync_slip:
            return ""
        do.open(one.off)
        return "inertia"

    def inertia(self, passed: float, period: float, now: Measured) -> str:
        """The input along its profile, by whichever element pulls the right way."""
        one, with_, do = self.one, self.with_, self.do
        too_long = passed > with_.longest and not (with_.launch_speed and not one.off)
        if do.is_dog(one.on):
            if too_long:
                return "failed"
            if abs(now.slips[one.on]) < with_.dog_slip:
                do.close([one.on], with_)
        if self._is_synchronous(now) or too_long:
            self.torque_factor, self.blip = 1.0, 0.0
            return "sync"
        do.carry(self.ahead, 0.0, with_)
        needed = self._profile.needed(passed, period, now)
        pulls = needed * self._profile.slip <= 0.0
        do.carry(one.on, abs(needed * one.on_torque) if pulls else 0.0, with_)
        if pulls or not do.slides(one.off):
            do.open(one.off)
        else:
            do.carry(one.off, abs(needed * one.off_torque), with_)
        self.torque_factor, self.blip = self._profile.torque_factor(now), self._profile.blip(period, now)
        return ""

    def sync(self, passed: float, _: float, now: Measured) -> str:
        """At equal speeds: the one that closes up to what it carries, the other down to nothing."""
        one, with_, do = self.one, self.with_, self.do
        let_go = not do.slides(one.off) or do.commands[one.off] == 0.0
        share = 1.0 if let_go else share_of(passed, 0.5 * with_.torque_time)
        torque = abs(now.input_torque)
        if do.slides(one.on):
            least = do.pressure(one.on, with_.margin * abs(one.on_torque) * torque, with_)
            touch = do.pressure(one.on, 0.0, with_)
            do.commands[one.on] = max(do.commands[one.on], touch + share * (least - touch))
        if share < 1.0:
            do.carry(one.off, (1.0 - share) * abs(one.off_torque) * torque, with_)
        else:
            do.open(*([one.off] if one.off else []))
        return "end" if share >= 1.0 else ""

    def end(self, passed: float, period: float, now: Measured) -> str:
        """The one that closed up to full pressure, until it does not slip any more; before another exchange at once."""
        one, with_, do = self.one, self.with_, self.do
        do.open(*([one.off] if one.off else []))
        if not do.slides(one.on) or self.ahead:
            return "done"
        full = with_.full_pressure
        do.commands[one.on] = min(full, do.commands[one.on] + full * period / max(with_.end_time, 1e-9))
        if do.commands[one.on] < full:
            return ""
        return "done" if abs(now.slips[one.on]) < with_.sync_slip or passed > with_.longest else ""

    # --------------------------------------------------------------------------------------------------- what holds

    def _takes_over(self, now: Measured) -> bool:
        """Upshifts under power and downshifts without: the one that closes can take over before speeds change."""
        one, torque = self.one, now.input_torque
        if one.idle or not self.do.slides(one.on) or not self.do.carries(one.off, one.off_torque * torque):
            return False
        return (torque >= 0.0) == (self._profile.lacks(now) <= 0.0)

    def _keep_down(self, now: Measured) -> None:
        """An engine that nothing loads yet is kept near its launch speed."""
        if self.with_.launch_speed and not self.one.off:
            beyond = now.input_speed - self.with_.launch_speed
            self.torque_factor = 1.0 - min(1.0, max(0.0, beyond / RUN_UP))

    def _unload(self, passed: float, now: Measured) -> str:
        """Less torque of the engine, or more where it drags, until the teeth of a dog clutch are free."""
        share = share_of(passed, self.with_.torque_time)
        driving = self._loaded > 0.0
        self.torque_factor, self.blip = 1.0 - share * driving, share * self.with_.blip * (not driving)
        if now.input_torque * self._loaded > UNLOADED * abs(self._loaded) and passed < self.with_.longest:
            return ""
        self.do.open(self.one.off)
        self.torque_factor, self.blip = 1.0, 0.0
        return "inertia"

    def _is_synchronous(self, now: Measured) -> bool:
        one, do = self.one, self.do
        if not one.on or one.idle:
            return True
        if do.is_dog(one.on):
            return now.sleeves.get(one.on, 0.0) > ENGAGED
        # a freewheel that would overrun never catches: without torque it is as good as in
        if not do.carries(one.on, one.on_torque * now.input_torque):
            return True
        passed = do.slides(one.on) and one.off != "" and self._profile.lacks(now) * self._profile.slip < 0.0
        return passed or abs(now.slips[one.on]) < self.with_.sync_slip
