"""clutchwork: two discs that a clutch joins; it locks by itself."""

# model
import numpy as np

import clutchwork as cw


def discs(pressure):
    d = cw.Driveline("two discs")
    engine, load = d.shaft("engine", inertia=0.2, speed=100.0), d.shaft("load", inertia=0.8)
    mu = cw.Coulomb(static=0.1, kinetic=0.1)
    d.add(cw.Clutch("c1", base=engine, follower=load, friction=mu, gain=5e-4, pressure=pressure))
    return d


ramp = cw.Ramp(height=2e5, duration=0.2)

# plot
run = discs(ramp).simulate(2.5)
run.plot("*.speed", "c1.torque", path="engagement.png")

# sweep
found = cw.sweep(discs(ramp), 4.0, vary={"c1.gain": np.linspace(4e-4, 8e-4, 20)}, outputs=cw.lock("c1"))
locks = found["lock(c1)"]

# controller
sim = cw.Simulator(discs(0.0))
for _ in range(250):
    pressed = np.clip(sim["c1.pressure"] - 20.0 * sim["c1.slip"], 0.0, 2e5)
    sim.set("c1.pressure", pressed)
    sim.advance(0.01)

# file
run.to_csv("engagement.csv")
