"""Under mpirun all ranks reduce together; what runs on one rank runs on each for itself.

    mpiexec -n 2 python3 ranks_test.py
"""
import os
import tempfile

from mpi4py import MPI

import elastogear as eg

world = MPI.COMM_WORLD
folder = world.bcast(tempfile.mkdtemp() if world.rank == 0 else None)
os.chdir(folder)
drive = eg.Drive({"drive": "cylindrical", "module": "3 mm", "face_width": "25 mm", "torque": "300 N m", "modes": 4,
                  "basis": "modal", "element_order": 1, "pinion": {"teeth": 17, "profile_shift": 0.3},
                  "wheel": {"teeth": 43, "profile_shift": 0.1}})
report = drive.reduce()
if world.rank == 0:  # the other ranks' reports lack what the first one alone knows
    assert report["ranks"].startswith(f"{world.size},"), report["ranks"]
result = drive.simulate(roll=0.1 * world.rank, contact_law="unilateral", output=f"result_{world.rank}.h5")
forces = world.allgather(float(abs(result.pair("pinion:wheel").force[-1]).max()))
assert len(set(forces)) == world.size, forces
try:
    drive.simulate(rol=1)
    raise AssertionError("an unknown option was taken")
except eg.Error as error:
    assert "unknown option" in str(error)
world.Barrier()
if world.rank == 0:
    import shutil
    os.chdir("/")
    shutil.rmtree(folder)
