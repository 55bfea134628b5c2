"""Drive files that the misuses of drives begin from. misuse_files.py makes of gears.yaml what every verb writes, gears_*, and a
sweep over two torques, gear_cases; the others are meshed at most."""
GEARS = """drive: cylindrical
element_order: 1
module: 3 mm
face_width: 9 mm
pinion: {teeth: 17, profile_shift: 0.3, file: gears_pinion.h5}
wheel: {teeth: 23, profile_shift: 0.1, file: gears_wheel.h5}
torque: 50 N m
speed: 1500 rpm
modes: 0
sweep_positions: 4
life: {duty_cycle: [50 N m, 1e6], sn: {knee_stress: 50 MPa}, tensile_strength: 800 MPa}
wear: {coefficient: 1e-9 mm^3/(N m), revolutions: 10}
"""
WORM = """drive: worm
element_order: 1
module: 2 mm
centre_distance: 50 mm
worm: {starts: 2}
wheel: {teeth: 41}
torque: 4 N m
"""
PLANETS = """drive: cylindrical
element_order: 1
module: 2 mm
face_width: 8 mm
gears: [sun, planet_1, planet_2, ring]
sun: {teeth: 24}
planet_1: {teeth: 24}
planet_2: {teeth: 24, mate: sun, direction: 120 deg}
ring: {teeth: 72, internal: true, mate: [planet_1, planet_2]}
torque: 30 N m
"""
DRIVES = {"gears.yaml": GEARS, "worm.yaml": WORM, "planets.yaml": PLANETS}
