"""From where bodies are looked at: views of whole bodies, of a point of a surface, and of where bodies meet."""
import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

import scene

MARGIN = 1.1  # around a whole body
ZOOM_SHARE = 0.09  # of the body's size: half height of the enlarged view


def points_of(data):
    return vtk_to_numpy(data.GetPoints().GetData())


def diagonal(points):
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def unit(vector):
    return vector / np.linalg.norm(vector)


def axis_of(points):
    """Axis of a worm (its longest) or of a wheel (its shortest principal direction)."""
    variance, direction = np.linalg.eigh(np.cov(points.T))
    return direction[:, 2 if variance[2] - variance[1] > variance[1] - variance[0] else 0]


def fitted_view(points, direction, up, aspect):
    """View that shows all points in a panel of this width/height ratio."""
    right = unit(np.cross(up, direction))
    frame = np.array([right, np.cross(direction, right), direction])
    seen = points @ frame.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    half_height = MARGIN * max(high[1] - low[1], (high[0] - low[0]) / aspect) / 2
    return scene.View((low + high) / 2 @ frame, diagonal(points) * direction, up, half_height)


def normal_at(surface, point):
    """Outward unit normal of the surface at one of its points."""
    normals = vtk.vtkPolyDataNormals()
    normals.SetInputData(surface)
    normals.SplittingOff()
    normals.AutoOrientNormalsOn()
    normals.Update()
    return vtk_to_numpy(normals.GetOutput().GetPointData().GetNormals())[point].astype(float)


def stress_views(surface, hot, aspect):
    """Whole body and the point `hot`, which is seen from outside and from the side it faces; the axis is horizontal."""
    points, normal = points_of(surface), normal_at(surface, hot)
    axis = axis_of(points)
    offset = points[hot] - (points.max(axis=0) + points.min(axis=0)) / 2
    radial = unit(offset - (axis @ offset) * axis)
    direction = unit(radial + 0.3 * normal + 0.15 * np.sign(axis @ normal) * axis)
    up = unit(np.cross(direction, axis))
    zoom = scene.View(points[hot], diagonal(points) * direction, up, ZOOM_SHARE * diagonal(points))
    return fitted_view(points, direction, up, aspect), zoom


def meeting_point(surfaces):
    """Centre of the region that the bounding boxes of all surfaces share."""
    low = np.max([points_of(surface).min(axis=0) for surface in surfaces], axis=0)
    high = np.min([points_of(surface).max(axis=0) for surface in surfaces], axis=0)
    return (low + high) / 2


def box_views(surfaces, boxes, direction, aspect):
    points = np.vstack([points_of(data) for data in surfaces + boxes])
    up, distance = np.array([0.0, 0.0, 1.0]), diagonal(points) * direction
    zoom = scene.View(meeting_point(surfaces), distance, up, ZOOM_SHARE * diagonal(points))
    return fitted_view(points, direction, up, aspect), zoom
