"""What a shift controller is calibrated with."""

from __future__ import annotations

from clutchwork.base import dataclass


@dataclass(frozen=True)
class ShiftSettings:
    """Times, pressures and gains of a shift controller; one for all shifts, or one for each kind of them.

    Parameters:
        fill_time: for which an element that closes is filled before it carries anything [s]
        fill_pressure: at which it is filled, at least the one at which it touches [Pa]
        full_pressure: at which elements of a gear that is in are held [Pa]
        torque_time: of the torque phase, in which one element takes over from the other [s]
        inertia_time: of the inertia phase, in which the speed of the input changes [s]
        usual_step: change of that speed up to which this holds [rad/s]; larger ones take longer in proportion
        stretch: most factor by which it takes longer, for a larger step or where the torque at hand is too little
        end_time: in which the element that closed is raised to full pressure [s]
        margin: capacity of an element that still holds, over the torque that it carries
        reduction: share by which the engine is asked to lower its torque in the inertia phase of an upshift under power
        pull: torque at the input with which elements pull it up in a downshift before the engine is asked to help [N m]
        closed_loop: whether the speed of the input is controlled to a profile; otherwise torques are those of the plan
        proportional: of the controller of that speed [1/s]
        integral: of the same [1/s2]
        sync_slip: below which an element is taken as synchronous [rad/s]
        dog_slip: slip below which a dog clutch is commanded to engage, below the one at which its teeth mesh [rad/s]
        cone: share of the force of a synchroniser with which a gear that waits is brought to speed, 0 to 1
        blip: most throttle that the engine is asked for on top of the driver's, where a downshift needs more than
        `pull`, nothing else can bring the input to the speed of a dog clutch, or one that opens must be unloaded
        adaptation: share of what a shift showed of the filling that is learnt for the next one, 0: nothing is
        longest: after which an exchange is closed whatever the slip [s]
        launch_speed: that the input keeps while an element drives off, where no converter does [rad/s]; 0: there is one
        launch_gain: proportional gain of that [1/s], far below the slowest mode of the drive shafts
        launch_throttle: above which it drives off
        let_go: share of the launch speed below which the input is released before the engine stalls
    """

    fill_time: float = 0.1
    fill_pressure: float = 0.0
    full_pressure: float = 1.0e6
    torque_time: float = 0.15
    inertia_time: float = 0.35
    usual_step: float = 150.0
    stretch: float = 2.5
    end_time: float = 0.1
    margin: float = 1.3
    reduction: float = 0.3
    pull: float = 40.0
    closed_loop: bool = True
    proportional: float = 25.0
    integral: float = 100.0
    sync_slip: float = 1.0
    dog_slip: float = 4.0
    cone: float = 0.4
    blip: float = 0.4
    adaptation: float = 1.0
    longest: float = 2.5
    launch_speed: float = 0.0
    launch_gain: float = 4.0
    launch_throttle: float = 0.02
    let_go: float = 0.6
