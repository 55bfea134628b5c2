"""Pictures of the bodies of a run, drawn from their body files: the parts with what is held, where they are at the start, and nodes."""
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

import results
import scene
import views

VTK_TYPES = (12, 25, 10, 24, 13, 26, 14)  # of cells, in the order of /mesh/cell_type
COLOURS = ("#D55E00", "#0072B2")  # vermillion and blue, told apart by colour-blind readers too
PLAIN, HELD, SPOT = "#C9CDD4", "#0033CC", "#D0021B"
SPEED, TORQUE = "#009E73", "#000000"  # of arrows
SPOT_SHARE = 0.004  # of a body's size: radius of a node that is marked
ASPECT = 1.2  # width/height of a panel
MOST_EDGES = 25000  # faces of a whole body whose edges can still be told from each other


class Body:
    """Outer surface of a body, in its own frame, with the mesh number of each of its points and whether it is held."""

    def __init__(self, name, path):
        self.name = name
        with results.open_file(path, "body") as file:
            self.X = file["mesh/X"][:]
            grid = volume_mesh(self.X, file["mesh/cell_type"][:], file["mesh/cell_offset"][:], file["mesh/cell_nodes"][:])
            free = np.zeros(len(self.X), dtype=bool)
            free[file["reduced/free_dof"][:] // 3] = True
        extract = vtk.vtkDataSetSurfaceFilter()
        extract.SetInputData(grid)
        extract.Update()
        self.surface = extract.GetOutput()
        self.nodes = vtk_to_numpy(self.surface.GetPointData().GetArray("node"))
        self.held = ~free[self.nodes]

    def point(self, node):
        """Number of the surface's point that is this node of the mesh, or that lies nearest to it."""
        return int(np.argmin(np.linalg.norm(self.X[self.nodes] - self.X[node], axis=1)))


def volume_mesh(X, cell_type, offset, nodes):
    """Unstructured grid with the point array "node": numbers of the nodes."""
    points, cells, grid = vtk.vtkPoints(), vtk.vtkCellArray(), vtk.vtkUnstructuredGrid()
    points.SetData(numpy_to_vtk(X, deep=True))
    cells.SetData(numpy_to_vtkIdTypeArray(offset.astype(np.int64), deep=True), numpy_to_vtkIdTypeArray(nodes.astype(np.int64), deep=True))
    types = numpy_to_vtk(np.array(VTK_TYPES)[cell_type].astype(np.uint8), deep=True, array_type=vtk.VTK_UNSIGNED_CHAR)
    grid.SetPoints(points)
    grid.SetCells(types, cells)
    numbers = numpy_to_vtkIdTypeArray(np.arange(len(X)), deep=True)
    numbers.SetName("node")
    grid.GetPointData().AddArray(numbers)
    return grid


def faces_of(surface, chosen):
    """The faces of a surface of which all points are chosen."""
    mask = numpy_to_vtk(chosen.astype(np.uint8), deep=True)
    mask.SetName("chosen")
    surface.GetPointData().AddArray(mask)
    select = vtk.vtkThreshold()
    select.SetInputData(surface)
    select.SetInputArrayToProcess(0, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_POINTS, "chosen")
    select.SetLowerThreshold(1)
    select.SetUpperThreshold(1)
    outer = vtk.vtkDataSetSurfaceFilter()
    outer.SetInputConnection(select.GetOutputPort())
    outer.Update()
    return outer.GetOutput()


def meshed_actor(surface, colour):
    """A surface with the edges of its faces."""
    actor = scene.plain_actor(surface, colour, 1)
    actor.GetProperty().EdgeVisibilityOn()
    actor.GetProperty().SetEdgeColor(scene.rgb(scene.EDGE))
    actor.GetProperty().SetLineWidth(0.5)
    return actor


def whole_actors(surface, colour, edges=True):
    """A body that is seen as a whole: with the edges of its faces, or where these are too many or not wanted, where it turns."""
    if edges and surface.GetNumberOfPolys() < MOST_EDGES:
        return [meshed_actor(surface, colour)]
    return [scene.plain_actor(surface, colour, 1), scene.crease_actor(surface)]


def sphere_actor(centre, radius):
    ball = vtk.vtkSphereSource()
    ball.SetCenter(*centre)
    ball.SetRadius(radius)
    ball.SetThetaResolution(24)
    ball.SetPhiResolution(24)
    ball.Update()
    actor = scene.plain_actor(ball.GetOutput(), SPOT, 1)
    actor.GetProperty().LightingOff()
    return actor


def read_bodies(items):
    return [Body(name, path) for name, path in results.key_values(items, "--body-file").items()]


def lying(body, direction):
    """The direction to look from, and what is up: a long body lies from left to right, others on the plane of x and y."""
    points = views.points_of(body.surface)
    axis = views.axis_of(points)
    if np.ptp(points @ axis) < 2 * np.linalg.norm(points - np.outer(points @ axis, axis), axis=1).max():
        return direction, np.array([0.0, 0, 1])
    direction = views.unit(direction - 0.8 * (direction @ axis) * axis)
    return direction, views.unit(np.cross(direction, axis))


def draw_parts(options):
    """Each body by itself, the faces whose nodes are held in blue."""
    bodies = read_bodies(options.body_file)
    picture = scene.Picture(900 * len(bodies), 820)
    for i, body in enumerate(bodies):
        left, right = i / len(bodies), (i + 1) / len(bodies)
        rest = faces_of(body.surface, np.ones(len(body.nodes), dtype=bool))
        held = faces_of(body.surface, body.held)
        view = views.fitted_view(views.points_of(body.surface), *lying(body, views.unit(np.array(options.view))), ASPECT)
        actors = whole_actors(held, HELD)
        actors[0].GetMapper().SetResolveCoincidentTopologyToPolygonOffset()
        actors[0].GetMapper().SetRelativeCoincidentTopologyPolygonOffsetParameters(-2, -2)
        picture.panel((left, 0.08, right, 1), whole_actors(rest, PLAIN) + actors, view)
        picture.panel((left, 0, right, 0.08), [scene.text_actor(f"{body.name}; blue: held", 0.5, 0.5, 34)])
    picture.save(options.out)


def placed(body, state):
    """The body's surface where it is at the first output time of a result file."""
    moved = vtk.vtkPolyData()
    moved.DeepCopy(body.surface)
    points = vtk_to_numpy(body.surface.GetPoints().GetData()) @ state["rotation"][0].T + state["position"][0]
    moved.GetPoints().SetData(numpy_to_vtk(points, deep=True))
    return moved


def arrow_actors(centre, axis, radius, colour):
    """An arrow around an axis: three quarters of a circle, and its head."""
    across = views.unit(np.cross(axis, [0.31, 0.53, 0.79]))
    angle = np.linspace(0, 1.5 * np.pi, 60)[:, None]
    circle = centre + radius * (np.cos(angle) * across + np.sin(angle) * np.cross(axis, across))
    points, line, tube, head = vtk.vtkPoints(), vtk.vtkPolyLineSource(), vtk.vtkTubeFilter(), vtk.vtkConeSource()
    points.SetData(numpy_to_vtk(circle, deep=True))
    line.SetPoints(points)
    tube.SetInputConnection(line.GetOutputPort())
    tube.SetRadius(0.07 * radius)
    tube.SetNumberOfSides(16)
    head.SetCenter(*(circle[-1] + 0.15 * (circle[-1] - circle[-4])))
    head.SetDirection(*(circle[-1] - circle[-2]))
    head.SetRadius(0.2 * radius)
    head.SetHeight(0.5 * radius)
    head.SetResolution(24)
    for source in (tube, head):
        source.Update()
    return [scene.plain_actor(source.GetOutput(), colour, 1) for source in (tube, head)]


def arrows_of(surface, state, direction):
    """Arrows of the speed and the torque with which a revolute body starts, beside its end that is seen."""
    if results.text(state.attrs["joint"]) != "revolute":
        return []
    axis, centre, points = state["rotation"][0] @ [0.0, 0, 1], state["position"][0], views.points_of(surface)
    along = (points - centre) @ axis
    radius = np.linalg.norm(points - centre - np.outer(along, axis), axis=1).max()
    side = 1 if axis @ direction >= 0 else -1
    radius = 0.6 * max(radius, np.ptp(along) / 4)
    end, step, actors = (side * along).max(), 0.35 * min(radius, np.ptp(along)), []
    for value, colour in ((state["rigid_velocity"][0, 0], SPEED), (state["joint_force"][0, 0], TORQUE)):
        if value != 0:
            actors += arrow_actors(centre + side * (end + (1 + len(actors) / 2) * step) * axis, np.sign(value) * axis, radius, colour)
    return actors


def draw_setup(options):
    """The bodies at the start of a run, whole and where they are about to touch; fixed ones grey."""
    direction, surfaces, actors, near_actors = views.unit(np.array(options.view)), [], [], []
    with results.open_file(options.result, "result") as file:
        for body, colour in zip(read_bodies(options.body_file), COLOURS):
            state = file[f"bodies/{body.name}"]
            surfaces.append(placed(body, state))
            colour = PLAIN if results.text(state.attrs["joint"]) == "fixed" else colour
            near_actors.append(meshed_actor(surfaces[-1], colour))
            actors += whole_actors(surfaces[-1], colour, edges=False) + arrows_of(surfaces[-1], state, direction)
    whole, near = views.box_views(surfaces, [], direction, ASPECT)
    picture = scene.Picture(1800, 820)
    picture.panel((0, 0.08, 0.498, 1), actors, whole)
    picture.panel((0.502, 0.08, 1, 1), near_actors, near)
    for i, (text, colour) in enumerate((("grey: fixed", scene.EDGE), ("arrow: speed", SPEED), ("arrow: torque", TORQUE))):
        picture.panel((i / 3, 0, (i + 1) / 3, 0.08), [scene.text_actor(text, 0.5, 0.5, 30, colour)])
    picture.save(options.out)


def draw_spots(options):
    """Each node in the middle of a view of its own."""
    bodies = {body.name: body for body in read_bodies(options.body_file)}
    spots = [(bodies[item.split("=")[0]], int(item.split("=")[1])) for item in options.node]
    rows, columns = (len(spots) + 1) // 2, min(len(spots), 2)
    picture = scene.Picture(900 * columns, 800 * rows)
    for i, (body, node) in enumerate(spots):
        left, top = (i % 2) / columns, 1 - (i // 2) / rows
        actors = [meshed_actor(body.surface, PLAIN), sphere_actor(body.X[node], SPOT_SHARE * views.diagonal(body.X))]
        view = views.stress_views(body.surface, body.point(node), ASPECT)[1]
        picture.panel((left, top - 0.92 / rows, left + 1 / columns, top), actors, view)
        picture.panel((left, top - 1 / rows, left + 1 / columns, top - 0.92 / rows), [scene.text_actor(f"{body.name} node {node}", 0.5, 0.5, 34)])
    picture.save(options.out)
