"""The folder of inputs that the misuses of misuse_cases.py start from: a bar of three hexahedra of 10 mm in several spellings,
bodies, results, stresses, and outputs `kept*` that a misuse must leave as they are; a pair of gears and what every verb makes of it."""
import os
import shutil

import h5py
import numpy as np

import misuse_drives

STEEL_MM = ("*MATERIAL, NAME=STEEL\n*ELASTIC\n210000., 0.3\n*DENSITY\n7.85e-9\n"
            "*SOLID SECTION, ELSET=ALL, MATERIAL=STEEL\n*BOUNDARY\nFIX, 1, 3\n")


class Failed(Exception):
    """Something that must work for the test to make sense did not."""


def bar(n=3, size=0.01):
    """n x 1 x 1 hexahedra as .inp: node sets FIX (x = 0), END (largest x), MIDDLE, CORNER; surface TOP at the largest z."""
    lines = ["*NODE"]
    lines += [f"{4 * i + k + 1}, {size * i:.9g}, {size * (k in (1, 2)):.9g}, {size * (k > 1):.9g}" for i in range(n + 1) for k in range(4)]
    lines.append("*ELEMENT, TYPE=C3D8, ELSET=ALL")
    lines += [", ".join(str(number) for number in (i + 1, *range(4 * i + 1, 4 * i + 9))) for i in range(n)]
    lines += ["*NSET, NSET=FIX", "1, 2, 3, 4", "*NSET, NSET=END", ", ".join(str(4 * n + k) for k in (1, 2, 3, 4)),
              "*NSET, NSET=MIDDLE", "5, 6, 7, 8", "*NSET, NSET=CORNER", "1"]
    lines += ["*SURFACE, NAME=TOP, TYPE=ELEMENT"] + [f"{i + 1}, S5" for i in range(n)]
    return "\n".join(lines) + "\n"


def thin_bar():
    """1 m x 50 mm x 50 mm, 10 x 2 x 2 hexahedra as .inp, with node sets FIX (x = 0) and END."""
    def node(i, j, k):
        return 1 + k + 3 * (j + 3 * i)
    corners = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))
    cells = [(i, j, k) for i in range(10) for j in range(2) for k in range(2)]
    lines = ["*NODE"] + [f"{node(i, j, k)}, {0.1 * i:.9g}, {0.025 * j:.9g}, {0.025 * k:.9g}"
                         for i in range(11) for j in range(3) for k in range(3)]
    lines.append("*ELEMENT, TYPE=C3D8, ELSET=ALL")
    lines += [", ".join([str(n + 1)] + [str(node(i + a, j + b, k + c)) for a, b, c in corners]) for n, (i, j, k) in enumerate(cells)]
    lines += ["*NSET, NSET=FIX", ", ".join(str(n) for n in range(1, 10)), "*NSET, NSET=END", ", ".join(str(n) for n in range(91, 100))]
    return "\n".join(lines) + "\n"


def write(folder, files):
    for name, text in files.items():
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(text)


def meshes(folder):
    good, mm = bar(), bar(size=10) + STEEL_MM
    write(folder, {
        "brick.inp": good,
        "nan.inp": good.replace("\n5, 0.01,", "\n5, nan,"),
        "inverted.inp": good.replace("2, 5, 6, 7, 8, 9, 10, 11, 12", "2, 9, 10, 11, 12, 5, 6, 7, 8"),
        "no_node.inp": good.replace("3, 9, 10, 11, 12, 13, 14, 15, 16", "3, 9, 10, 11, 12, 13, 14, 15, 99"),
        "twice.inp": good.replace("\n2, 0, 0.01, 0\n", "\n2, 0, 0.01, 0\n2, 0, 0.02, 0\n"),
        "cell_twice.inp": good.replace("3, 9, 10, 11, 12, 13, 14, 15, 16", "3, 9, 10, 11, 12, 13, 14, 15, 16\n4, 5, 6, 7, 8, 9, 10, 11, 12"),
        "unmerged.inp": good.replace("3, 9, 10, 11, 12, 13, 14, 15, 16", "3, 17, 18, 19, 20, 13, 14, 15, 16").replace(
            "*ELEMENT", "17, 0.02, 0, 0\n18, 0.02, 0.01, 0\n19, 0.02, 0.01, 0.01\n20, 0.02, 0, 0.01\n*ELEMENT"),
        "slash.inp": good.replace("NSET=CORNER", "NSET=LEFT/CORNER"),
        "slash_in_elements.inp": good.replace("ELSET=ALL", "ELSET=LEFT/ALL"),
        "commas.inp": good.replace("NSET=FIX", 'NSET="FIX, LEFT"'),
        "empty_set.inp": good + "*NSET, NSET=EMPTY\n",
        "flat_cell.inp": good.replace("\n15, 0.03, 0.01, 0.01\n16, 0.03, 0, 0.01\n", "\n15, 0.23, 0.01, 0.01\n16, 0.23, 0, 0.01\n"),
        "curve.csv": "time [s],modulus [GPa]\n0.01,200\n1,180\n100,150\n",
        "no_units.csv": "time [s],modulus\n1,2\n",
        "negative_modulus.csv": "time [s],modulus [Pa]\n1,2\n2,-2\n",
        "soft_curve.csv": "time [s],modulus [Pa]\n1,2\n2,soft\n",
        "no_cells.inp": good[:good.index("*ELEMENT")],
        "empty.inp": "",
        "folded.inp": good.replace("3, 9, 10, 11, 12, 13, 14, 15, 16", "3, 9, 10, 11, 12, 14, 13, 15, 16"),
        "reduced_integration.inp": good.replace("C3D8", "C3D8R"),
        "long.inp": bar(12), "thin.inp": thin_bar(), "metres.inp": bar(size=10), "other_mesh.inp": bar().replace("\n13, 0.03,", "\n13, 0.031,"),
        "millimetres.inp": mm, "micrometres.inp": bar(size=1e4), "inches.inp": bar(size=0.01 / 0.0254),
        "partly.inp": mm.replace("FIX, 1, 3", "FIX, 1, 2"),
        "brass.inp": mm.replace("MATERIAL=STEEL", "MATERIAL=BRASS"),
        "k.mtx": "1,1, 1,1, 1.0\n1,1, 1,2, nan\n",
        "k2.mtx": "1,1, 1,1, 1.0\n17,1, 17,1, 2.0\n",
        "brick.msh": "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"})


def tables(folder):
    body = "a: {file: body.h5}\nts: {dt: 1e-7, max_time: 3e-7}\noutput: kept_run.h5\n"
    write(folder, {
        "malformed.yaml": "mesh: [1, 2\nfoo: {",
        "two.yaml": "bodies: [a, b]\na: {file: body.h5}\nb: {file: body.h5, joint: free}\nts: {dt: 1e-7, max_time: 1e-7}\n",
        "one.yaml": "bodies: [a]\n" + body,
        "key_twice.yaml": "bodies: [a]\n" + body + "gravity: [0, 0, -9.81]\ngravity: [0, 0, 0]\n",
        "section_twice.yaml": "bodies: [a]\n" + body + "a: {joint: revolute}\n",
        "misspelt.yaml": "bodies: [a]\n" + body + "gravty: [0, 0, -9.81]\n",
        "tab.yaml": "bodies: [a]\n" + body + "contact:\n\tdepth: 1e-3\n",
        "text_number.yaml": "bodies: [a]\n" + body + "gravity: [0, 0, down]\n",
        "nested_twice.yaml": "ts_dt: 1e-7\nts: {dt: 2e-7}\n",
        "commas.yaml": "restrain: ['FIX, LEFT', 'END:y']\n",
        "empty.yaml": "",
        "binary.yaml": "\x01\x02\x03: [\x04",
        "times.txt": "1e-7\n2\n",
        "short.csv": "time,torque\n0,1\n5e-7,2\n",
        "equal.csv": "0,1\n0,2\n",
        "falling.csv": "0,1\n2,1\n1,2\n",
        "word.csv": "time,torque\n0,1\n1,much\n",
        "nan.csv": "time,torque\n0,1\n1,nan\n",
        "empty.csv": "",
        "variants.csv": "variant,modes\na,3\n",
        "few.csv": "wheel_skew,pinion_tip_relief\n0.01,1e-5\n0.02\n",
        "seconds.csv": "pinion_tip_relief\n3 s\n",
        "one_column.csv": "time\n0\n1\n",
        "misspelt_options.txt": "-modes 3\n-epss_tol 4\n",
        "bad_options.txt": "-modes 3\nmodes 4\n",
        "itself.txt": "-modes 3\n-options_file itself.txt\n",
        "prefix.txt": "-prefix_push ts_\n-dt 1e-7\n-prefix_pop\nalias -end -ts_max_time\n-end 1e-6\n"})
    drives(folder)
    write(folder, misuse_drives.DRIVES)


def drives(folder):
    drive = ("drive: cylindrical\nmodule: 3 mm\nface_width: 25 mm\nspeed: 1500 rpm\npinion: {teeth: 17, rigid: true, file: drive_pinion.h5}\n"
             "wheel: {teeth: 23, rigid: true, file: drive_wheel.h5}\nsize: tiny\nelement_order: 1\nmodes: 0\nsweep: {positions: 1}\nsimulate: {output: kept_run.h5}\n")
    names = [f"v{i}" for i in range(300)]
    write(folder, {
        "drive.yaml": drive + "torque: 300\n",
        "flag.yaml": drive.replace("teeth: 17", "teeth: 17, internal: ''"),
        "speed.yaml": drive.replace(" rpm", ""),
        "misspelt_drive.yaml": drive + "log_veiw: 1\n",
        "both_torques.yaml": drive + "torque: 300\ntorques: [100, 200]\n",
        "many_torques.yaml": drive + f"torques: [{', '.join(str(100 + i) for i in range(100))}]\n",
        "many_keys.yaml": drive + f"torque: 300\nvariants: [{', '.join(names)}]\n" + "".join(
            f"variant_{name}: {{wheel_skew: 0.01 deg, pinion_tip_relief: {i + 1} um}}\n" for i, name in enumerate(names)),
        "variants_in_um.csv": "pinion_tip_relief [um],wheel_skew [deg]\n20,0.01\n",
        "variants_in_s.csv": "pinion_tip_relief [s]\n20\n",
        "two_separators.csv": "100,5 1e6\n",
        "duty_in_s.csv": "torque [s],revolutions\n100,1e6\n",
        "duty_in_kN.csv": "torque [kN m],revolutions\n0.1,1e5\n",
        "revolutions_in_h.csv": "torque [N m],revolutions [h]\n100,1e6\n",
        "two_fields.csv": "time [s],torque [N m]\n0,1\n1,2,\n2,3,4\n",
        "ramp_in_ms.csv": "time [ms],torque [kN m]\n0,0\n1,0.001\n",
        "ramp_in_parentheses.csv": "time (ms),torque (kN m)\n0,0\n1,0.001\n",
        "ramp_in_lbf_ft.csv": "time (ms),torque (lbf ft)\n0,0\n1,0.001\n",
        "ramp_of_blanks.csv": "time [ms] torque [kN m]\n0 0\n1 0.001\n",
        "ramp_of_metres.csv": "time (ms),torque (mm)\n0,0\n1,0.001\n",
        "duty_in_lbf_ft.csv": "torque (lbf ft),revolutions\n100,1e5\n",
        "variants_in_parentheses.csv": "pinion_tip_relief (um),wheel_skew (deg)\n20,0.01\n",
        "ramp_in_mm.csv": "time [ms],torque [mm]\n0,0\n1,0.001\n",
        "for_all.yaml": "bodies: [a]\na: {file: body.h5}\nstress_recovery: average\nelement_mass: lumped\nstress: {a: MIDDLE}\n"
                        "result: run.h5\noutput: kept_stress.h5\nsimulate_output: kept_run.h5\nts: {dt: 1e-7, max_time: 1e-6}\n"})


def bodies(bench):
    bench.good("{reduce} -output body.h5")
    bench.good("{reduce} -output seven.h5 -modes 7")
    bench.good("{reduce} -output soft.h5 -material_E 70e9")
    bench.good("{reduce} -output other_mesh.h5 -mesh other_mesh.inp")
    bench.good("{reduce} -output full.h5 -basis full")
    bench.good("{reduce} -output rubber.h5 -material_E 1e6 -material_rho 1000 -basis full -invariants full")
    bench.good("{reduce} -output no_surface.h5 -surface ''")
    for name in ("other.h5", "kept.h5"):
        shutil.copy(bench.path("body.h5"), bench.path(name))
    for verb in ("mesh", "reduce"):
        bench.good("{elastogear} " + verb + " drive.yaml")
    bench.good("{elastogear} mesh -part wheel -size tiny -element_order 1 -mesh wheel.msh -z2 41")


def runs(bench):
    bench.good("{single} -output run.h5")
    bench.good("{single} -a_joint revolute -a_omega0 100 -output turning.h5")
    bench.good("{single} -output run_full.h5 -a_file full.h5")
    bench.good("{recover} -output stress.h5")
    bench.good("{recover} -output stress_full.h5 -result run_full.h5")
    for name, source in (("kept_run.h5", "run.h5"), ("kept_stress.h5", "stress.h5"), ("kept_stress_a_MIDDLE.csv", "stress_a_MIDDLE.csv")):
        shutil.copy(bench.path(source), bench.path(name))


def gears(bench):
    bench.good("{elastogear} reduce gears.yaml")
    bench.good("{elastogear} simulate gears.yaml -analysis sweep -torques 50,100 -sweep_positions 2 -output gear_cases.h5")
    bench.good("{elastogear} simulate gears.yaml -analysis sweep")
    for verb in ("recover", "evaluate", "life", "wear"):
        bench.good("{elastogear} " + verb + " gears.yaml")


def truncate(folder, source, target):
    with open(os.path.join(folder, source), "rb") as file:
        content = file.read()
    with open(os.path.join(folder, target), "wb") as file:
        file.write(content[:len(content) // 2])


def make(bench):
    meshes(bench.folder)
    tables(bench.folder)
    bodies(bench)
    runs(bench)
    gears(bench)
    for source in ("body.h5", "run.h5", "stress.h5", "wheel.msh", "gears_result.h5"):
        truncate(bench.folder, source, "truncated_" + source)
    os.makedirs(bench.path("folder"))
    os.symlink("body.h5", bench.path("link.h5"))
    write(bench.folder, {"kept.msh": "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Comments\nelastogear mesh, in m\n$EndComments\n", "kept_1.csv": "an earlier table\n"})


def place_of(path, value):
    """Where the last byte of a double is that the file holds once."""
    with open(path, "rb") as file:
        content = file.read()
    bits = np.float64(value).tobytes()
    if content.count(bits) != 1:
        raise Failed(f"{path}: holds {value} {content.count(bits)} times")
    return content.index(bits) + 7


def flip(bench, name, dataset):
    """Changes one byte, of the exponent of a double, in the middle of a dataset."""
    with h5py.File(bench.path(name), "r") as file:
        item = file[dataset]
        if item.dtype != np.float64 or item.size == 0:
            raise Failed(f"{name}: {dataset} has no doubles")
        if item.chunks:
            at = item.id.get_chunk_info(item.id.get_num_chunks() // 2).byte_offset + 7
        else:
            at = place_of(bench.path(name), np.ravel(item[()])[item.size // 2])
    with open(bench.path(name), "r+b") as file:
        file.seek(at)
        byte = file.read(1)[0]
        file.seek(at)
        file.write(bytes([byte ^ 0x20]))


def edit(bench, name, dataset, change):
    """Writes change(values) into a dataset, checksums and all."""
    with h5py.File(bench.path(name), "r+") as file:
        file[dataset][...] = change(file[dataset][...])


def attribute(bench, name, key, value):
    with h5py.File(bench.path(name), "r+") as file:
        old = file.attrs.get_id(key)
        file.attrs.create(key, value, shape=old.shape, dtype=old.dtype)


def attribute_of(bench, name, place, key, value):
    """An attribute of the group `place`, of another value or kind."""
    with h5py.File(bench.path(name), "r+") as file:
        del file[place].attrs[key]
        file[place].attrs[key] = value


def remove(bench, name, dataset):
    with h5py.File(bench.path(name), "r+") as file:
        del file[dataset]
