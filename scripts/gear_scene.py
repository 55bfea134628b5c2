#!/usr/bin/python3
"""Both gears of a drive in one scene, drawn by VTK without a screen: von Mises stress on the deformed bodies, and the contact pattern on
the loaded flank of the second one; as a picture, or as an animation of the roll angles.

    gear_scene.py picture   FIELDS.pvd --evaluation EVALUATION.h5 --body-file SECOND.h5 --out PICTURE.png [--frame 0]
    gear_scene.py animation FIELDS.pvd --out FILM.mp4|FILM.gif [--seconds 4]

The .pvd file is that of `elastogear recover ... -field_times all`; ffmpeg makes the film.
"""
import argparse
import os
import subprocess
import sys
import tempfile

import numpy as np
import vtk

import pictures
import results
import scene
from page import fields
from views import axis_of, diagonal, fitted_view, unit

ASPECT = 1.25  # of a panel
WIDTH, HEIGHT = 1800, 860
NEAR = 0.16  # of both gears' size: half height of the view of the mesh
TILT = 0.35  # of the view against the second gear's axis
MARGIN = 1.25  # around the flank
GAP = 0.008  # between panels, of the picture's width


def frames_of(options):
    """Names of the two gears, and for each time the files of both and the time."""
    series = fields.series(options.fields)
    names = options.gears or list(series)[:2]
    if len(names) < 2 or not set(names) <= set(series):
        sys.exit(f"{options.fields}: has fields of {', '.join(series) or 'no body'}, expected {' and '.join(names) if options.gears else 'two gears'}")
    first, second = (series[name] for name in names)
    return names, [((file, mate), time) for (time, file), (_, mate) in zip(first, second)]


class Body:
    """One gear at one roll angle: its volume mesh with fields in place, and its deformed surface with von Mises stress in MPa."""

    def __init__(self, path, scale=0):
        self.data = pictures.read(path)
        self.points = pictures.points_of(self.data)
        force = pictures.array(self.data.GetPointData(), "contact_force", path)
        self.touched = self.points[np.linalg.norm(force, axis=1) > 0]
        self.surface, self.stress, self.scale = pictures.stress_surface(path, scale)

    def axis(self):
        return axis_of(self.points)


def mesh_point(bodies):
    """Where the gears touch, or the middle between them."""
    touched = np.vstack([body.touched for body in bodies])
    return touched.mean(axis=0) if touched.size else np.mean([body.points.mean(axis=0) for body in bodies], axis=0)


class Views:
    """The whole drive and the mesh, seen nearly along the second gear's axis; they stay for all frames."""

    def __init__(self, bodies):
        points = np.vstack([body.points for body in bodies])
        axis = bodies[1].axis()
        centre = bodies[1].points.mean(axis=0)
        up = unit(mesh_point(bodies) - centre - axis * (axis @ (mesh_point(bodies) - centre)))
        axis = axis if axis[2] >= 0 else -axis
        direction = unit(axis + TILT * np.cross(up, axis) + 0.5 * TILT * up)
        up = unit(up - direction * (direction @ up))
        self.whole = fitted_view(points, direction, up, ASPECT)
        size = diagonal(points)
        self.near = scene.View(mesh_point(bodies), size * direction, up, NEAR * size)


def stress_actors(bodies, table, edges):
    actors = []
    for body in bodies:
        pictures.colour_by(body.surface, body.stress)
        actors += [scene.scalar_actor(body.surface, table, edges=edges), scene.crease_actor(body.surface)]
    return actors


def end_of_colours(bodies):
    return pictures.colour_range(np.concatenate([body.stress for body in bodies]))


def two_panels(picture, bodies, views, end, right):
    """Whole drive and mesh in the left part of a picture up to `right`."""
    table = scene.colour_table(end)
    picture.panel((0, 0.14, right / 2, 0.92), stress_actors(bodies, table, False), views.whole)
    picture.panel((right / 2 + GAP, 0.14, right, 0.92), stress_actors(bodies, table, True), views.near)
    above = max(body.stress.max() for body in bodies) > end
    picture.panel((0, 0, right, 0.14), [scene.text_actor("von Mises stress in MPa" + ("; blue: above" if above else ""), 0.5, 0.82, 24),
                                        scene.colour_bar(table, above)])


def pattern_of(evaluation, case, gear):
    """Name, radii, z and pressures (MPa) of the pattern of a gear, and its tooth with the largest pressure."""
    with results.open_file(evaluation, "evaluation") as file:
        cases = file["cases"]
        group = cases[case or next(iter(cases))]
        for pair in (group[name] for name in group if ":" in name):
            for name in pair.get("pattern", ()):
                if name.rsplit("_", 1)[0] == gear:
                    p, tooth = pair["pattern/" + name], int(pair[f"pressure/peak_on_{gear}/tooth"][()])
                    return name, p["radius"][:], p["z"][:], p["pressure"][:] / 1e6, tooth
    sys.exit(f"{evaluation}: has no contact pattern of '{gear}'")


def at_places(radii, z, pressure, places):
    """Pressure of the pattern's cells at places (radius, z); beyond the pattern that of its rim."""
    order = np.argsort(radii)
    i = np.abs(radii[order][None, :] - places[:, :1]).argmin(axis=1)
    j = np.abs(z[None, :] - places[:, 1:]).argmin(axis=1)
    return pressure[order[i], j]


CUTS = 16  # along each side of a face: patterns are finer than meshes
MOST = 75  # % of a pattern's loaded places have colours of their own; loads of edges, on small shares of the surface, are far above


def fine_flank(faces, own, placed):
    """A flank's faces cut finely: polygons in place, and the points in the body frame. own, placed: n x 3, of all nodes."""
    points, cells, frame = vtk.vtkPoints(), vtk.vtkCellArray(), []
    s = np.linspace(-1, 1, CUTS + 1)
    for face in faces:
        first = points.GetNumberOfPoints()
        for v in s:
            for u in s:
                N = 0.25 * np.array([(1 - u) * (1 - v), (1 + u) * (1 - v), (1 + u) * (1 + v), (1 - u) * (1 + v)])
                points.InsertNextPoint(N @ placed[face])
                frame.append(N @ own[face])
        for b in range(CUTS):
            for a in range(CUTS):
                at = first + b * (CUTS + 1) + a
                cells.InsertNextCell(4, (at, at + 1, at + CUTS + 2, at + CUTS + 1))
    flank = vtk.vtkPolyData()
    flank.SetPoints(points)
    flank.SetPolys(cells)
    return flank, np.array(frame)


def flank_actors(body_file, body, pattern):
    """The loaded flank of one tooth with its pattern on the body in place, and the view of it."""
    name, radii, z, pressure, tooth = pattern
    side = name.rsplit("_", 1)[1]
    with results.open_file(body_file, "body") as file:
        own = file["mesh/X"][:]
        sets = [key for key in file["mesh/face_sets"] if key.split("_")[0] in ("tooth", "thread") and key.endswith("_" + side)
                and int(key.split("_")[1]) == tooth]
        if not sets:
            sys.exit(f"{body_file}: has no faces of tooth {tooth}, {side}")
        faces = file["mesh/face_sets/" + sets[0]][:].astype(int)
    flank, frame = fine_flank(faces, own, body.points)
    places = np.column_stack([np.hypot(frame[:, 0], frame[:, 1]), frame[:, 2]])
    pictures.colour_by(flank, at_places(radii, z, pressure, places))
    corners = body.points[faces]
    normal = unit(np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]).sum(axis=0))
    axis = body.axis()
    high = np.percentile(pressure[pressure > 0], MOST)
    table = scene.colour_table(pictures.round_down(high / 5) * np.ceil(high / pictures.round_down(high / 5)))
    actor = scene.scalar_actor(flank, table, edges=False)
    actor.GetMapper().SetResolveCoincidentTopologyToPolygonOffset()
    actor.GetMapper().SetRelativeCoincidentTopologyPolygonOffsetParameters(-2, -2)
    undeformed = pictures.surface_of(body.data)
    points = pictures.points_of(flank)
    outward = unit(points.mean(axis=0) - body.points.mean(axis=0) - axis * (axis @ (points.mean(axis=0) - body.points.mean(axis=0))))
    direction = unit(normal + 0.4 * outward)
    view = fitted_view(points, direction, unit(outward - direction * (direction @ outward)), ASPECT)
    view.half_height *= MARGIN
    view.direction = view.direction / np.linalg.norm(view.direction) * diagonal(body.points)
    return [scene.plain_actor(undeformed, scene.GREY, 1), scene.crease_actor(undeformed), actor], view, table, f"{name.replace('_', ', ')} flank, tooth {tooth}"


def draw_picture(options):
    (_, gear), frames = frames_of(options)
    if not 0 <= options.frame < len(frames):
        sys.exit(f"{options.fields}: has no frame {options.frame}, only 0 to {len(frames) - 1}")
    paths, roll = frames[options.frame]
    scale = min(Body(path).scale for path in paths)
    bodies = [Body(path, scale) for path in paths]
    picture = scene.Picture(int(WIDTH * 1.5), HEIGHT)
    two_panels(picture, bodies, Views(bodies), end_of_colours(bodies), 2 / 3)
    actors, view, table, name = flank_actors(options.body_file, bodies[1], pattern_of(options.evaluation, options.case, gear))
    picture.panel((2 / 3 + GAP, 0.14, 1, 0.92), actors, view)
    picture.panel((2 / 3, 0, 1, 0.14), [scene.text_actor("largest contact pressure over all roll angles in MPa; blue: more, at edges", 0.5, 0.82, 24), scene.colour_bar(table, False)])
    picture.panel((0, 0.92, 2 / 3, 1), [scene.text_actor(f"roll angle {roll:.3f} pitches, deformation x {scale:g}", 0.5, 0.5, 30)])
    picture.panel((2 / 3, 0.92, 1, 1), [scene.text_actor(f"contact pattern: {name}", 0.5, 0.5, 30)])
    picture.save(options.out)


def draw_animation(options):
    _, frames = frames_of(options)
    first = [Body(path) for path in frames[0][0]]
    scale, views = min(body.scale for body in first), Views(first)
    bodies = [[Body(path, scale) for path in paths] for paths, _ in frames]
    end = end_of_colours([body for pair in bodies for body in pair])
    with tempfile.TemporaryDirectory() as folder:
        for number, (pair, (_, roll)) in enumerate(zip(bodies, frames)):
            picture = scene.Picture(WIDTH // 2 * 2, HEIGHT)
            two_panels(picture, pair, views, end, 1)
            picture.panel((0, 0.92, 1, 1), [scene.text_actor(f"roll angle {roll:.3f} pitches, deformation x {scale:g}", 0.5, 0.5, 30)])
            picture.save(os.path.join(folder, f"{number:04d}.png"))
        encode(folder, len(frames) / options.seconds, options.out)


def encode(folder, rate, out):
    """A film of the pictures of a folder; the extension says which."""
    gif = "split[a][b];[a]palettegen=max_colors=96[p];[b][p]paletteuse=dither=none"
    more = ["-vf", f"scale=900:-1:flags=lanczos,{gif}"] if out.endswith(".gif") else ["-pix_fmt", "yuv420p", "-r", "25"]
    command = ["ffmpeg", "-y", "-loglevel", "error", "-framerate", f"{rate:g}", "-i", os.path.join(folder, "%04d.png"), *more, out]
    if subprocess.run(command, check=False).returncode != 0:
        sys.exit(f"{out}: ffmpeg cannot write it; scripts/setup installs ffmpeg")
    print(out)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    picture = commands.add_parser("picture", help="both gears and the pattern of the second one")
    picture.add_argument("--evaluation", required=True, help="file of `elastogear evaluate`")
    picture.add_argument("--case", help="default: the first one")
    picture.add_argument("--body-file", required=True, help="body file of the second gear")
    picture.add_argument("--frame", type=int, default=0, help="number of the roll angle, from 0")
    picture.set_defaults(draw=draw_picture)
    animation = commands.add_parser("animation", help="all roll angles")
    animation.add_argument("--seconds", type=float, default=4, help="length of the film")
    animation.set_defaults(draw=draw_animation)
    for command in (picture, animation):
        command.add_argument("fields", help=".pvd file of recover")
        command.add_argument("--gears", nargs=2, metavar=("FIRST", "SECOND"), help="default: the first two")
        command.add_argument("--out", required=True, help="file to write")
    return parser.parse_args()


def main():
    options = arguments()
    if not os.environ.get("DISPLAY"):  # VTK 9.1 draws off screen only beside a display server
        os.execvp("xvfb-run", ["xvfb-run", "-a", sys.executable, *sys.argv])
    options.draw(options)


if __name__ == "__main__":
    main()
