"""From the numbers of a drawing to the stresses at the roots: two spur gears at rest under 300 N m.

Expected: the contact ratio is 1.516, and the wheel bears the torque of the pinion over the ratio of teeth.
"""
import elastogear as eg

drive = eg.Drive({
    "drive": "cylindrical",
    "module": "3 mm",
    "face_width": "25 mm",
    "pinion": {"teeth": 17, "profile_shift": 0.3},
    "wheel": {"teeth": 43, "profile_shift": 0.1},
    "torque": "300 N m",
    "modes": 10,
})
for part, facts in drive.facts.items():
    print(part, facts)

wheel = drive.meshes()["wheel"]  # arrays of numpy
print(f"mesh of the wheel: {len(wheel.points)} nodes, {len(wheel.face_sets['flanks'])} faces of flanks")

drive.reduce()
result = drive.simulate(roll=0.25)  # in pitches, the angle at which the gears are looked at
stress = drive.recover()

force = result.pair("pinion:wheel").force[-1]
torque = result.pair("pinion:wheel").torque[-1][2]  # on the wheel, about the axis of the pinion
print(f"contact force {force} N")
for each in stress.sets:
    print(f"{each.body} {each.set}: {1e-6 * each.von_mises[-1].max():.1f} MPa"
          f" +- {1e-6 * each.total_peak_error[-1]:.1f}")

picture = result.plot()
picture.figure.savefig("contact_force.png")
stress.plot().figure.savefig("stress.png")

assert 1.516 <= drive.facts["pinion:wheel"]["contact ratio"] < 1.517
assert abs(torque - 300) < 0.01 * 300
assert 100e6 < stress["pinion", "root"].von_mises[-1].max() < 500e6
