"""Draws VTK data off screen: panels side by side in one picture, with titles and a colour bar."""
import vtk

# light to dark through yellow, orange, red: order stays visible to colour-blind readers and in grey print
HEAT = ("#f4f4ee", "#ffeda0", "#fed976", "#feb24c", "#fd8d3c", "#fc4e2a", "#e31a1c", "#b10026", "#4d0012")
TABLE_SIZE = 256
ABOVE = "#2166ac"  # of values beyond the table's end: blue, which is none of its colours
BLACK, GREY, EDGE = "#000000", "#B8BCC4", "#707070"
ROUNDING = 1e-4  # of a colour table's end: values that are equal to it are not above
CREASE = 20  # degrees, between faces whose common edge is drawn


def rgb(colour):
    return [int(colour[i:i + 2], 16) / 255 for i in (1, 3, 5)]


def colour_table(end):
    """Colours from 0 to `end`, and one for what is above."""
    transfer = vtk.vtkColorTransferFunction()
    for i, colour in enumerate(HEAT):
        transfer.AddRGBPoint(i / (len(HEAT) - 1), *rgb(colour))
    table = vtk.vtkLookupTable()
    table.SetNumberOfTableValues(TABLE_SIZE)
    for i in range(TABLE_SIZE):
        table.SetTableValue(i, *transfer.GetColor(i / (TABLE_SIZE - 1)), 1)
    table.SetRange(0, end * (1 + ROUNDING))
    table.SetAboveRangeColor(*rgb(ABOVE), 1)
    table.UseAboveRangeColorOn()
    return table


def scalar_actor(surface, table, edges):
    """Surface coloured by its active point scalars, without light and shade: its colours are those of the bar."""
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(surface)
    mapper.SetLookupTable(table)
    mapper.UseLookupTableScalarRangeOn()
    mapper.InterpolateScalarsBeforeMappingOn()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().LightingOff()
    actor.GetProperty().SetEdgeVisibility(edges)
    actor.GetProperty().SetEdgeColor(rgb(EDGE))
    return actor


def crease_actor(surface):
    """Edges at which a surface turns or ends: the shape of a body without light and shade."""
    edges = vtk.vtkFeatureEdges()
    edges.SetInputData(surface)
    edges.SetFeatureAngle(CREASE)
    edges.ColoringOff()
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(edges.GetOutputPort())
    mapper.ScalarVisibilityOff()
    mapper.SetResolveCoincidentTopologyToPolygonOffset()
    mapper.SetRelativeCoincidentTopologyLineOffsetParameters(-1, -60)
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().LightingOff()
    actor.GetProperty().SetColor(rgb(EDGE))
    return actor


def plain_actor(surface, colour, opacity):
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(surface)
    mapper.ScalarVisibilityOff()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(rgb(colour))
    actor.GetProperty().SetOpacity(opacity)
    return actor


def box_actor(boxes, colour, opacity):
    """Semi-transparent polytopes with their edges."""
    actor = plain_actor(boxes, colour, opacity)
    actor.GetProperty().EdgeVisibilityOn()
    actor.GetProperty().SetEdgeColor(rgb(colour))
    actor.GetProperty().SetLineWidth(1.0)
    return actor


def text_actor(text, x, y, size, colour=BLACK):
    """Centred text; x, y in 0..1 of its panel."""
    actor = vtk.vtkTextActor()
    actor.SetInput(text)
    prop = actor.GetTextProperty()
    prop.SetFontSize(size)
    prop.SetColor(rgb(colour))
    prop.SetJustificationToCentered()
    prop.SetVerticalJustificationToCentered()
    actor.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    actor.SetPosition(x, y)
    return actor


def colour_bar(table, extended):
    """Horizontal bar with numbers for the lower part of a panel of its own; extended by the colour of what is above its end."""
    bar = vtk.vtkScalarBarActor()
    bar.SetLookupTable(table)
    bar.SetMaximumNumberOfColors(TABLE_SIZE)
    bar.SetOrientationToHorizontal()
    bar.SetNumberOfLabels(6)
    bar.SetLabelFormat("%.4g" if table.GetRange()[1] >= 1000 else "%.3g")  # less than the rounding of its end
    bar.SetPosition(0.2, 0.02)
    bar.SetPosition2(0.6, 0.6)
    bar.UnconstrainedFontSizeOn()
    bar.SetDrawAboveRangeSwatch(extended)
    bar.SetDrawAnnotations(False)
    labels = bar.GetLabelTextProperty()
    labels.SetColor(rgb(BLACK))
    labels.SetFontSize(24)
    labels.BoldOff()
    labels.ItalicOff()
    labels.ShadowOff()
    return bar


class View:
    """Parallel projection: looks at `focus` from the side `direction`; `half_height` in m."""

    def __init__(self, focus, direction, up, half_height):
        self.focus, self.direction, self.up, self.half_height = focus, direction, up, half_height

    def apply(self, renderer):
        camera = renderer.GetActiveCamera()
        camera.ParallelProjectionOn()
        camera.SetFocalPoint(*self.focus)
        camera.SetPosition(*(self.focus + self.direction))
        camera.SetViewUp(*self.up)
        camera.SetParallelScale(self.half_height)
        renderer.ResetCameraClippingRange()


class Picture:
    """A white off-screen window that is filled panel by panel and saved as PNG."""

    def __init__(self, width, height):
        self.window = vtk.vtkRenderWindow()
        self.window.SetOffScreenRendering(1)
        self.window.SetSize(width, height)
        self.window.SetMultiSamples(0)  # depth peeling, which transparent surfaces need, excludes multisampling
        self.window.SetAlphaBitPlanes(1)
        self.panel((0, 0, 1, 1), [])  # white also between the panels

    def panel(self, area, actors, view=None):
        """area: left, bottom, right, top in 0..1 of the picture."""
        renderer = vtk.vtkRenderer()
        renderer.SetViewport(*area)
        renderer.SetBackground(1, 1, 1)
        for actor in actors:
            if isinstance(actor, vtk.vtkActor2D):
                renderer.AddActor2D(actor)
            else:
                renderer.AddActor(actor)
        self.window.AddRenderer(renderer)
        if view is not None:
            renderer.SetUseDepthPeeling(1)
            renderer.SetUseFXAA(True)
            view.apply(renderer)
        return renderer

    def save(self, path):
        self.window.Render()
        grab = vtk.vtkWindowToImageFilter()
        grab.SetInput(self.window)
        grab.ReadFrontBufferOff()
        grab.ShouldRerenderOff()
        writer = vtk.vtkPNGWriter()
        writer.SetFileName(path)
        writer.SetInputConnection(grab.GetOutputPort())
        writer.Write()
        print(path)
