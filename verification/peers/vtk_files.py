"""What VTK, the library whose file format it is, reads of the files that `output.vtu = true` leaves.

A question names files, and the index of a series if there is one. meshio cannot be asked: of VTK's cells it knows no polyline.
The index (`.pvd`) is ParaView's own; VTK has no reader for it, so Python's XML parser takes its place.
"""

import json
import xml.etree.ElementTree

from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader


def arrays(data):
    named = (data.GetArray(i) for i in range(data.GetNumberOfArrays()))
    return {array.GetName(): vtk_to_numpy(array).tolist() for array in named}


def grid(path):
    reader = vtkXMLUnstructuredGridReader()
    failures = []
    reader.AddObserver("ErrorEvent", lambda *_: failures.append(path))
    reader.SetFileName(path)
    reader.Update()
    if failures or reader.GetErrorCode() != 0:
        raise ValueError(f"VTK cannot read {path}")
    read = reader.GetOutput()
    cells, points = [], vtkIdList()
    for i in range(read.GetNumberOfCells()):
        read.GetCellPoints(i, points)
        cells.append([points.GetId(k) for k in range(points.GetNumberOfIds())])
    return {
        "name": read.GetPoints().GetData().GetName(),
        "points": vtk_to_numpy(read.GetPoints().GetData()).tolist(),
        "types": [read.GetCell(i).GetClassName() for i in range(read.GetNumberOfCells())],
        "cells": cells,
        "point_data": arrays(read.GetPointData()),
        "cell_data": arrays(read.GetCellData()),
    }


def series(path):
    entries = xml.etree.ElementTree.parse(path).getroot().find("Collection").findall("DataSet")
    return [[float(entry.get("timestep")), entry.get("file")] for entry in entries]


def answer(question):
    asked = json.loads(question)
    return json.dumps({
        "series": series(asked["index"]),
        "grids": [grid(path) for path in asked["files"]],
    })
