"""The life of two spur gears over a duty cycle: stresses at the roots over a pitch, counted and added up.

Expected: the life ends at the gear with the weaker material, and ten times the revolutions are ten times the damage.
"""
import elastogear as eg

drive = eg.Drive({
    "drive": "cylindrical",
    "module": "3 mm",
    "face_width": "25 mm",
    "pinion": {"teeth": 17, "profile_shift": 0.3},
    "wheel": {"teeth": 43, "profile_shift": 0.1},
    "modes": 10,
    "torques": ["200 N m", "300 N m"],
    "sweep_positions": 8,
    "life": {
        "sn": {"knee_stress": "200 MPa", "knee_cycles": 1e6, "slope": 5},
        "mean_stress": "goodman",
        "tensile_strength": "1000 MPa",
        "wheel": {"sn": {"knee_stress": "120 MPa"}},
    },
})
drive.reduce()
for result in drive.sweep():
    force = result.pair("pinion:wheel").force
    print(f"{result.inputs['torque [N m]']} N m: contact force {abs(force).max():.0f} N over {len(result.time)} roll angles")

damage = {}
for revolutions in [1e6, 1e7]:
    life = drive.life(duty_cycle=["250 N m", revolutions, "300 N m", 0.1 * revolutions])
    for each in life.summary["sets"]:
        print(f"{each['body']} {each['set']}: damage {each['damage']:.3g}")
        damage[each["body"], revolutions] = each["damage"]

assert damage["wheel", 1e6] > damage["pinion", 1e6] > 0
assert abs(damage["wheel", 1e7] / damage["wheel", 1e6] - 10) < 1e-9
