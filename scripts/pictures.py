#!/usr/bin/python3
"""Pictures drawn by VTK, without a screen:

  pictures.py stress FIELD.vtu --out PICTURE.png
      von Mises stress on the deformed body, whole and around the largest stress
  pictures.py boxes --surfaces A.vtu B.vtu --boxes A.vtp B.vtp --levels 1 5 leaf --out PICTURE.png
      bodies with the k-DOPs of some tree levels, whole and where the bodies meet; all files in one frame
  pictures.py parts --body-file worm=worm.h5 wheel=wheel.h5 --out PICTURE.png
      each body by itself, with what is held
  pictures.py setup RESULT.h5 --body-file worm=worm.h5 wheel=wheel.h5 --out PICTURE.png
      the bodies at the start of a run
  pictures.py spots --body-file worm=worm.h5 --node worm=12 worm=345 --out PICTURE.png
      nodes on their bodies
"""
import argparse
import os
import sys

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

import bodies
import results
import scene
from bodies import COLOURS as BODY_COLOURS
from views import box_views, diagonal, points_of, stress_views, unit

WARP_SHARE = 0.04  # of the body's size: how large the largest displacement is drawn
STANDS_OUT = 3  # times that quantile
SHOWN_QUANTILE = 0.999  # colours end there, so that a few contact nodes do not hide the roots
BOX_HEIGHT, BOX_ASPECT = 675, 1.1  # of one panel with boxes: pixels, width/height
GAP = 0.004  # between panels, of the picture's width


def read(path):
    """The data set of a .vtu or .vtp file; exits with a message when it cannot be read."""
    readers = {".vtu": vtk.vtkXMLUnstructuredGridReader, ".vtp": vtk.vtkXMLPolyDataReader}
    extension = os.path.splitext(path)[1]
    if extension not in readers or not os.path.isfile(path):
        sys.exit(f"{path}: expected an existing .vtu or .vtp file")
    reader = readers[extension]()
    reader.SetFileName(path)
    reader.Update()
    if reader.GetOutput().GetNumberOfPoints() == 0:
        sys.exit(f"{path}: holds no points")
    return reader.GetOutput()


def array(attributes, name, path):
    """The data array of this name, which a unit may follow: "displacement [m]"."""
    for i in range(attributes.GetNumberOfArrays()):
        if attributes.GetArrayName(i).split(" [")[0] == name:
            return vtk_to_numpy(attributes.GetArray(i))
    sys.exit(f"{path}: has no data array '{name}'")


def surface_of(data):
    """Outer surface of a volume mesh, with its point data."""
    extract = vtk.vtkDataSetSurfaceFilter()
    extract.SetInputData(data)
    extract.Update()
    return extract.GetOutput()


def round_down(value):
    """Largest 1, 2 or 5 times a power of ten that is not above `value`."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(power * max(digit for digit in (1, 2, 5) if digit * power <= value))


def warp_scale(displacement, size):
    """Enlargement with which the largest displacement is drawn at about WARP_SHARE of the body's size."""
    largest = np.linalg.norm(displacement, axis=1).max()
    return round_down(WARP_SHARE * size / largest) if largest > 0 else 1.0


def move_points(surface, displacement):
    moved = points_of(surface) + displacement
    surface.GetPoints().SetData(numpy_to_vtk(moved, deep=True))


def colour_by(surface, values):
    scalars = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
    surface.GetPointData().SetScalars(scalars)


def colour_range(stress):
    """Where the colours end: a round number beyond the largest stress, or where a few stand out far beyond all but those."""
    shown = float(np.quantile(stress, SHOWN_QUANTILE))
    if stress.max() <= STANDS_OUT * shown:
        shown = float(stress.max())
    step = round_down(shown / 5) if shown > 0 else 0.2
    return step * np.ceil(shown / step)


def stress_surface(path, scale=0):
    """Deformed surface, von Mises stress (MPa) at its points, enlargement of the displacement (chosen when 0)."""
    surface = surface_of(read(path))
    stress = array(surface.GetPointData(), "von_mises", path) / 1e6
    displacement = array(surface.GetPointData(), "displacement", path)
    scale = scale or warp_scale(displacement, diagonal(points_of(surface)))
    move_points(surface, scale * displacement)
    return surface, stress, scale


def stress_label(stress, end):
    """What the bar shows, with the largest stress (all in MPa), and what is above its end."""
    if stress.max() <= end:
        return f"von Mises stress in MPa, largest {stress.max():.4g}"
    return f"von Mises stress in MPa; blue: above {end:.4g}, to {stress.max():.4g} ({(stress > end).sum()} of {stress.size} nodes)"


def error_label(surface, stress):
    """The estimated errors of the largest stress, when the field has them."""
    names = [surface.GetPointData().GetArrayName(i) for i in range(surface.GetPointData().GetNumberOfArrays())]
    errors = {}
    for by, start, trusted in (("reduction", "error_of_von_mises [", results.TRUSTED), ("mesh", "error_of_von_mises_by_mesh [", results.TRUSTED_MESH),
                               ("steps", "error_of_von_mises_by_steps [", results.TRUSTED_MESH)):
        found = [name for name in names if name and name.startswith(start)]
        if found:
            error = vtk_to_numpy(surface.GetPointData().GetArray(found[0]))[int(stress.argmax())] / 1e6
            errors[by] = f"by the {by} {float(f'{error:.2g}'):g}" + (", not to be trusted" if error > trusted * stress.max() else "")
    return "its estimated error: " + ", ".join(errors.values()) if errors else "its error is not estimated"


def draw_stress(options):
    pattern, shown, scale = stress_surface(options.like or options.field, options.scale)
    end = options.end or colour_range(shown)
    table = scene.colour_table(end)
    views = stress_views(pattern, int(shown.argmax()), aspect=1.2)
    surface, stress, scale = stress_surface(options.field, scale)
    colour_by(surface, stress)
    name = options.title or os.path.splitext(os.path.basename(options.field))[0].replace("_", " ")
    picture = scene.Picture(1800, 1000)
    whole = [scene.scalar_actor(surface, table, edges=False), scene.crease_actor(surface)]
    picture.panel((0, 0.18, 0.5, 0.92), whole, views[0])
    picture.panel((0.5, 0.18, 1, 0.92), [scene.scalar_actor(surface, table, edges=True)], views[1])
    picture.panel((0, 0.92, 1, 1), [scene.text_actor(f"{name}: deformation x {scale:g}", 0.5, 0.5, 32)])
    picture.panel((0, 0.145, 1, 0.18), [scene.text_actor(stress_label(stress, end), 0.5, 0.5, 28)])
    picture.panel((0, 0.11, 1, 0.145), [scene.text_actor(error_label(surface, stress), 0.5, 0.5, 28)])
    picture.panel((0, 0.015, 1, 0.11), [scene.colour_bar(table, stress.max() > end)])
    picture.save(options.out)


def boxes_of_level(boxes, level, path):
    """The polytopes of one tree level; level "leaf" stands for the deepest one in the file."""
    levels = array(boxes.GetCellData(), "level", path)
    wanted = levels.max() if level == "leaf" else int(level)
    if wanted not in levels:
        sys.exit(f"{path}: has no boxes of level {wanted}, only of {', '.join(map(str, np.unique(levels)))}")
    select = vtk.vtkThreshold()
    select.SetInputData(boxes)
    select.SetInputArrayToProcess(0, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_CELLS, "level")
    select.SetLowerThreshold(wanted)
    select.SetUpperThreshold(wanted)
    select.Update()
    return surface_of(select.GetOutput())


def distinct_names(paths):
    """File names without extension and without the leading words that all share: impact_worm -> worm."""
    words = [os.path.splitext(os.path.basename(path))[0].split("_") for path in paths]
    while all(len(w) > 1 and w[0] == words[0][0] for w in words):
        words = [w[1:] for w in words]
    return [" ".join(w) for w in words]


def box_legend(surfaces):
    names = distinct_names(surfaces)
    places = np.linspace(0, 1, len(names) + 2)[1:-1]
    return [scene.text_actor(name, x, 0.5, 34, colour) for name, x, colour in zip(names, places, BODY_COLOURS)]


def draw_boxes(options):
    surfaces = [surface_of(read(path)) for path in options.surfaces]
    trees = [read(path) for path in options.boxes]
    views = box_views(surfaces, trees, unit(np.array(options.view)), aspect=BOX_ASPECT)
    picture = scene.Picture(round(BOX_HEIGHT * BOX_ASPECT * len(options.levels)), round(BOX_HEIGHT / 0.45))
    for i, level in enumerate(options.levels):
        left, right = i / len(options.levels), (i + 1) / len(options.levels)
        actors = [scene.plain_actor(surface, scene.GREY, 0.45) for surface in surfaces]
        for boxes, path, colour in zip(trees, options.boxes, BODY_COLOURS):
            actors.append(scene.box_actor(boxes_of_level(boxes, level, path), colour, 0.25))
        picture.panel((left, 0.5, right, 0.95), actors, views[0])
        picture.panel((left + GAP, 0.05, right - GAP, 0.5), actors, views[1])
        title = f"{options.title}, " + ("leaves" if level == "leaf" else f"level {level}")
        picture.panel((left, 0.95, right, 1), [scene.text_actor(title, 0.5, 0.5, 34)])
    picture.panel((0, 0, 1, 0.05), box_legend(options.surfaces))
    picture.save(options.out)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    stress = commands.add_parser("stress", help="von Mises stress on the deformed body")
    stress.add_argument("field", help=".vtu with point data displacement (m) and von_mises (Pa)")
    stress.add_argument("--scale", type=float, default=0, help="enlargement of the displacement; default: automatic")
    stress.add_argument("--like", metavar="FIELD", help="another .vtu whose view, enlargement and colours are taken")
    stress.add_argument("--end", type=float, default=0, metavar="MPA", help="where the colours end; default: a round number beyond all but a few nodes")
    stress.add_argument("--title", help="default: the file name")
    stress.set_defaults(draw=draw_stress)
    boxes = commands.add_parser("boxes", help="bodies with their k-DOPs")
    boxes.add_argument("--surfaces", nargs="+", required=True, metavar="FILE", help=".vtu or .vtp of each body")
    boxes.add_argument("--boxes", nargs="+", required=True, metavar="FILE", help=".vtp with cell data level")
    boxes.add_argument("--levels", nargs="+", default=["1", "5", "leaf"], help="tree levels, root 0; leaf: the deepest")
    boxes.add_argument("--title", default="k-DOPs", help="default: %(default)s")
    boxes.set_defaults(draw=draw_boxes)
    parts = commands.add_parser("parts", help="each body, with what is held")
    setup = commands.add_parser("setup", help="the bodies at the start of a run")
    setup.add_argument("result", help="result file of `elastogear simulate`")
    spots = commands.add_parser("spots", help="nodes on their bodies")
    spots.add_argument("--node", nargs="+", required=True, metavar="BODY=NUMBER", help="mesh nodes to show")
    for command, function in ((parts, bodies.draw_parts), (setup, bodies.draw_setup), (spots, bodies.draw_spots)):
        command.add_argument("--body-file", nargs="+", required=True, metavar="BODY=FILE")
        command.set_defaults(draw=function)
    for command in (boxes, parts, setup):
        command.add_argument("--view", nargs=3, type=float, default=(0.35, 0.75, 0.55), metavar=("X", "Y", "Z"), help="from where to look")
    for command in (stress, boxes, parts, setup, spots):
        command.add_argument("--out", required=True, help="PNG file to write")
    return parser.parse_args()


def main():
    options = arguments()
    if not os.environ.get("DISPLAY"):  # VTK 9.1 draws off screen only beside a display server
        os.execvp("xvfb-run", ["xvfb-run", "-a", sys.executable, *sys.argv])
    options.draw(options)


if __name__ == "__main__":
    main()
