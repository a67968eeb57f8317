"""Reads a .vtu file with VTK's own reader and compares it with what a JSON file says it holds.

usage: read_vtu.py FILE.vtu EXPECTED.json        compare one frame
       read_vtu.py --series FILE.pvd             print "time points cells" of each frame of a series

Prints each difference and exits with 1 when there is one. Numbers must be equal to the last bit.
"""
import json
import os
import sys
import xml.etree.ElementTree

from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader


def read(path):
    """The grid in a .vtu file; errors that VTK's reader reports end the program."""
    problems = []
    reader = vtkXMLUnstructuredGridReader()

    def note(_caller, event):
        problems.append(event)

    reader.AddObserver("ErrorEvent", note)
    reader.AddObserver("WarningEvent", note)
    if not reader.CanReadFile(path):
        sys.exit(f"{path}: VTK cannot read this file")
    reader.SetFileName(path)
    reader.Update()
    if problems:
        sys.exit(f"{path}: VTK reports {problems}")
    return reader.GetOutput()


def tuples(array):
    return [list(array.GetTuple(i)) for i in range(array.GetNumberOfTuples())]


def fields(data):
    return {data.GetArrayName(i): tuples(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}


def content(grid):
    cells = []
    for i in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(i)
        cells.append([cell.GetCellType()] + [cell.GetPointId(k) for k in range(cell.GetNumberOfPoints())])
    return {
        "time": grid.GetFieldData().GetArray("TimeValue").GetValue(0),
        "points": [list(grid.GetPoint(i)) for i in range(grid.GetNumberOfPoints())],
        "point_type": grid.GetPoints().GetData().GetDataTypeAsString(),
        "cells": cells,
        "point_data": fields(grid.GetPointData()),
        "cell_data": fields(grid.GetCellData()),
    }


def compare(path, expected_path):
    found = content(read(path))
    with open(expected_path, encoding="utf-8") as file:
        expected = json.load(file)
    if sorted(found) != sorted(expected):
        sys.exit(f"{expected_path}: holds {sorted(expected)}, must hold {sorted(found)}")
    different = [key for key in found if found[key] != expected[key]]
    for key in different:
        print(f"{path}: {key} is {found[key]}, expected {expected[key]}")
    return 1 if different else 0


def series(path):
    root = xml.etree.ElementTree.parse(path).getroot()
    assert root.tag == "VTKFile" and root.get("type") == "Collection", root.attrib
    for frame in root.find("Collection"):
        grid = read(os.path.join(os.path.dirname(path), frame.get("file")))
        print(float(frame.get("timestep")), grid.GetNumberOfPoints(), grid.GetNumberOfCells())
    return 0


if __name__ == "__main__":
    sys.exit(series(sys.argv[2]) if sys.argv[1] == "--series" else compare(sys.argv[1], sys.argv[2]))
