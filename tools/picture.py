#!/usr/bin/python3
"""Draws frames of a run side by side as one PNG: tools/picture.py SERIES.pvd OUT.png TIME...

Needs python3-vtk9 and a display (xvfb-run serves). Times are in seconds; the frame nearest to each is drawn.
"""

import pathlib
import sys
import xml.etree.ElementTree as xml

import vtk

WIDTH, HEIGHT = 360, 420  # pixels of one frame
VIEW_UP = (0, 0, 1)


def frames_of(series):
    sets = xml.parse(series).getroot().iter("DataSet")
    return [(float(s.get("timestep")), series.parent / s.get("file")) for s in sets]


def surface(file):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(file))
    skin = vtk.vtkGeometryFilter()
    skin.SetInputConnection(reader.GetOutputPort())
    normals = vtk.vtkPolyDataNormals()
    normals.SetInputConnection(skin.GetOutputPort())
    normals.SplittingOff()
    normals.Update()
    return normals.GetOutput()


def actor(data, colour, edges):
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.ScalarVisibilityOff()
    out = vtk.vtkActor()
    out.SetMapper(mapper)
    look = out.GetProperty()
    look.SetColor(colour)
    look.SetSpecular(0.15)
    look.SetEdgeVisibility(edges)
    look.SetEdgeColor(0.25, 0.3, 0.4)
    look.SetLineWidth(0.5)
    return out


def floor(bounds):
    centre = ((bounds[0] + bounds[1]) / 2, (bounds[2] + bounds[3]) / 2)
    size = 1.2 * max(bounds[1] - bounds[0], bounds[3] - bounds[2])
    plane = vtk.vtkPlaneSource()
    plane.SetOrigin(centre[0] - size, centre[1] - size, 0)
    plane.SetPoint1(centre[0] + size, centre[1] - size, 0)
    plane.SetPoint2(centre[0] - size, centre[1] + size, 0)
    plane.Update()
    return plane.GetOutput()


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    series, target = pathlib.Path(sys.argv[1]), sys.argv[2]
    times = [float(t) for t in sys.argv[3:]]
    frames = frames_of(series)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(WIDTH * len(times), HEIGHT)
    start = surface(frames[0][1]).GetBounds()
    centre = [(start[0] + start[1]) / 2, (start[2] + start[3]) / 2, start[5] * 0.46]
    for i, time in enumerate(times):
        data = surface(min(frames, key=lambda f: abs(f[0] - time))[1])
        view = vtk.vtkRenderer()
        view.SetViewport(i / len(times), 0, (i + 1) / len(times), 1)
        view.SetBackground(1, 1, 1)
        view.AddActor(actor(data, (0.62, 0.72, 0.88), True))
        ground = actor(floor(start), (0.87, 0.86, 0.83), False)
        ground.GetProperty().LightingOff()
        view.AddActor(ground)
        label = vtk.vtkTextActor()
        label.SetInput(f"{time:g} s")
        label.GetTextProperty().SetColor(0.2, 0.2, 0.2)
        label.GetTextProperty().SetFontSize(18)
        label.SetPosition(12, 12)
        view.AddActor2D(label)
        camera = view.GetActiveCamera()
        camera.SetFocalPoint(centre)
        camera.SetPosition(centre[0] + 0.25 * start[5], centre[1] - 2.9 * start[5], centre[2] + 0.75 * start[5])
        camera.SetViewUp(VIEW_UP)
        view.ResetCameraClippingRange()
        window.AddRenderer(view)
    window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(target)
    writer.SetInputConnection(grab.GetOutputPort())
    writer.Write()


main()
