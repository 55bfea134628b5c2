"""A worm drive whose worm is brought to 100 rad/s by a speed controller, against a torque on the wheel.

The controller is proportional and integral: torque = K_P (wanted - speed) + integral. Its integral changes between the
steps; within a step the torque is a function of time and speed. The wanted speed grows within 4 ms, smoothly. Expected:
from 6 to 7 ms the worm has its speed within 1 % in the mean, and the mean torque is that of the wheel over the ratio,
0.0976 N m, within 10 %; teeth that rattle in their backlash make both fluctuate.
"""
import math

import elastogear as eg

SPEED, RISE, END, DT = 100, 4e-3, 7e-3, 4e-6  # rad/s, s, s, s
K_P, K_I = 0.03, 40  # N m s, N m

drive = eg.Drive({
    "drive": "worm",
    "module": "2 mm",
    "centre_distance": "50 mm",
    "worm": {"starts": 2, "rigid": True},
    "wheel": {"teeth": 41, "torque": "-2 N m", "damping": {"beta": 1e-6}},
    "modes": 5,
    "basis": "modal",
    "contact": {"points": "nodes", "two_pass": True, "hysteresis": 0.5},
})
drive.reduce()


def wanted(t):
    return SPEED if t > RISE else 0.5 * SPEED * (1 - math.cos(math.pi * t / RISE))


class Controller:
    def __init__(self):
        self.integral = 0  # N m
        self.torques = []  # N m, after each step

    def torque(self, t, angle, speed):
        return K_P * (wanted(t) - speed) + self.integral

    def update(self, simulation):
        time, speed = simulation.state.time, simulation.state.body("worm").s_dot[0]
        self.integral += K_I * (wanted(time) - speed) * DT
        self.torques.append(self.torque(time, 0, speed))


controller = Controller()
result = drive.simulate(forces={"worm": controller.torque}, on_step=controller.update,
                        ts={"dt": DT, "max_time": END}, output_dt="0.1 ms")
speed = result.body("worm").s_dot[result.time > END - 1e-3, 0].mean()
last = controller.torques[-int(1e-3 / DT):]
torque = sum(last) / len(last)
print(f"in the last millisecond: speed {speed:.2f} rad/s, torque {torque:.4f} N m")
assert abs(speed / SPEED - 1) < 0.01
assert abs(torque / (2 * 2 / 41) - 1) < 0.1
