"""python-control: two discs that a clutch joins; without events the sign of the slip is smoothed, and it creeps."""

# model
import control as ct
import matplotlib.pyplot as plt
import numpy as np

J1, J2, KINETIC, WIDTH = 0.2, 0.8, 0.1, 0.1


def torque(t, x, u, params):
    return params.get("gain", 5e-4) * KINETIC * u[0] * np.tanh((x[0] - x[1]) / WIDTH)


def update(t, x, u, params):
    return [-torque(t, x, u, params) / J1, torque(t, x, u, params) / J2]


def output(t, x, u, params):
    return [x[0], x[1], torque(t, x, u, params)]


discs = ct.nlsys(update, output, inputs=["pressure"], states=["engine", "load"], outputs=["engine", "load", "torque"])
time = np.linspace(0.0, 2.5, 2501)
pressure = np.minimum(time / 0.2, 1.0) * 2e5

# plot
run = ct.input_output_response(discs, time, pressure, [100.0, 0.0], solve_ivp_method="LSODA")
run.plot()
plt.savefig("engagement.png")

# sweep
locks = []
for gain in np.linspace(4e-4, 8e-4, 20):
    longer = np.linspace(0.0, 4.0, 4001)
    pressed = np.minimum(longer / 0.2, 1.0) * 2e5
    found = ct.input_output_response(
        discs, longer, pressed, [100.0, 0.0], params={"gain": gain}, solve_ivp_method="LSODA"
    )
    locks.append(longer[np.argmax(found.outputs[0] - found.outputs[1] < WIDTH)])


# controller
def decide(t, x, u, params):
    return np.clip(x + 20.0 * (u[0] - u[1]), 0.0, 2e5)


# a plant that is sampled needs a step of its own; the pressure is held over 10 ms
x, pressed, log = np.array([100.0, 0.0]), np.zeros(1), []
for step in range(250):
    pressed = decide(0.01 * step, pressed, x, {})
    part = ct.input_output_response(
        discs, [0.01 * step, 0.01 * (step + 1)], np.tile(pressed, (2, 1)).T, x, solve_ivp_method="LSODA"
    )
    x = part.states[:, -1]
    log.append(x)

# file
run.to_pandas().to_csv("engagement.csv")
