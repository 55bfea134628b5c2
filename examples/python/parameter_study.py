"""Three misalignments of the wheel, from gear data to root stress. Expected: the more skew, the more stress."""
import numpy as np

import elastogear as eg

drive = eg.Drive({"drive": "cylindrical", "module": "3 mm", "face_width": "25 mm", "torque": "300 N m",
                  "pinion": {"teeth": 17, "profile_shift": 0.3}, "wheel": {"teeth": 43, "profile_shift": 0.1},
                  "modes": 10, "roll": 0.25})
drive.reduce()
peaks = []
for skew in [0, 0.05, 0.1]:  # degrees
    result = drive.simulate(wheel={"skew": f"{skew} deg"})
    peaks.append(drive.recover()["pinion", "root"].von_mises[-1].max())
    print(f"skew {skew} deg: pinion root {1e-6 * peaks[-1]:.1f} MPa, "
          f"pressure {1e-6 * result.pair('pinion:wheel').pressure[-1]:.0f} MPa")
assert np.all(np.diff(peaks) > 0)
