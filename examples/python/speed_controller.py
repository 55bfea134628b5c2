"""A worm drive whose worm is brought to 100 rad/s by a speed controller, against a torque on the wheel.

The controller is proportional and integral: torque = K_P (wanted - speed) + integral. Its integral changes between the
steps; within a step the torque is a function of the speed alone. Expected: from 8 to 10 ms the worm has its speed
within 1 % in the mean; teeth that rattle in their backlash make it fluctuate.
"""
import elastogear as eg

WANTED, K_P, K_I = 100, 0.01, 8  # rad/s, N m s, N m

drive = eg.Drive({
    "drive": "worm",
    "module": "2 mm",
    "centre_distance": "50 mm",
    "worm": {"starts": 2},
    "wheel": {"teeth": 41},
    "modes": 5,
    "basis": "modal",
})
drive.reduce()


class Controller:
    def __init__(self):
        self.integral = 0  # N m

    def torque(self, t, angle, speed):
        return K_P * (WANTED - speed) + self.integral

    def update(self, simulation):
        state = simulation.state
        self.integral += K_I * (WANTED - state.body("worm").s_dot[0]) * DT


DT = 2e-6  # s
controller = Controller()
result = drive.simulate(forces={"worm": controller.torque}, on_step=controller.update, contact_points="nodes",
                        wheel={"torque": "-2 N m"}, worm={"rigid": True},
                        ts={"dt": DT, "max_time": "10 ms"}, output_dt="0.1 ms")
speed = result.body("worm").s_dot[:, 0]
mean = speed[-20:].mean()
print(f"speed from 8 to 10 ms: {mean:.2f} rad/s in the mean, integral {controller.integral:.4f} N m")
assert abs(mean / WANTED - 1) < 0.01
