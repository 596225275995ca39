"""PathSim: two discs that a clutch joins; the lock-up is an event of the model's own."""

# model
import numpy as np
from pathsim import Connection, Simulation
from pathsim.blocks import ODE, Function, Scope, Source
from pathsim.events import ZeroCrossing
from pathsim.solvers import RKDP54

J1, J2, KINETIC = 0.2, 0.8, 0.1


def simulation(pressure, gain=5e-4):
    locked = []

    def accelerations(speeds, load, t):
        torque = 0.0 if locked else KINETIC * gain * load[0]
        return np.array([-torque / J1, torque / J2])

    def lock(t):
        both = discs.engine.state @ [J1, J2] / (J1 + J2)
        discs.engine.state = np.array([both, both])
        locked.append(t)
        events[0].off()

    discs = ODE(accelerations, np.array([100.0, 0.0]))
    torque = Function(lambda p: 0.0 if locked else KINETIC * gain * p)
    scope = Scope(labels=["engine, rad/s", "load, rad/s", "torque, N m"])
    events = [ZeroCrossing(lambda t: discs.engine.state @ [1.0, -1.0], lock)]
    links = [
        Connection(pressure, discs, torque),
        Connection(discs[0], scope[0]),
        Connection(discs[1], scope[1]),
        Connection(torque, scope[2]),
    ]
    made = Simulation([pressure, discs, torque, scope], links, events, Solver=RKDP54, dt_max=1e-2, log=False)
    return made, scope, locked


def ramp():
    return Source(lambda t: 2e5 * min(t / 0.2, 1.0))


# plot
made, scope, locked = simulation(ramp())
made.run(2.5)
figure, _ = scope.plot()
figure.savefig("engagement.png")

# sweep
locks = []
for gain in np.linspace(4e-4, 8e-4, 20):
    made, _, locked = simulation(ramp(), gain)
    made.run(4.0)
    locks.append(locked[0])

# controller
pressure = Source(lambda t: pressed[0])
pressed = [0.0]
made, scope, locked = simulation(pressure)
for _ in range(250):
    speeds = made.blocks[1].engine.state
    pressed[0] = 0.0 if locked else np.clip(pressed[0] + 20.0 * (speeds[0] - speeds[1]), 0.0, 2e5)
    made.run(0.01)

# file
scope.save("engagement.csv")
