#!/usr/bin/python3
"""Whether VTK's own reader, ParaView's too, finds in a series what the CSV of the same run has.

    build/spindrift SCENE --headless --time 0.1 --series a.pvd
    build/spindrift SCENE --headless --time 0.1 --series a.csv
    tests/read_with_vtk.py a.pvd            (apt-get install python3-vtk9 python3-numpy)
"""
import pathlib
import sys
import xml.etree.ElementTree as xml

import numpy
import vtk
from vtk.util.numpy_support import vtk_to_numpy

COLUMNS = {"velocity [m/s]": ("vx [m/s]", "vy [m/s]", "vz [m/s]"),
           "density [kg/m³]": ("rho [kg/m³]",), "pressure [Pa]": ("p [Pa]",)}


def read(path):
    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def check(fluid, table):
    names = table.open().readline().strip().split(",")
    rows = numpy.loadtxt(table, delimiter=",", skiprows=1)
    columns = {name: rows[:, k] for k, name in enumerate(names)}
    places = numpy.stack([columns[f"{axis} [m]"] for axis in "xyz"], axis=1)
    assert numpy.array_equal(vtk_to_numpy(fluid.GetPoints().GetData()), places), table
    for field, parts in COLUMNS.items():
        values = vtk_to_numpy(fluid.GetPointData().GetArray(field))
        wanted = numpy.stack([columns[part] for part in parts], axis=1)
        values = values.reshape(wanted.shape)
        assert numpy.allclose(values, wanted, rtol=1e-6, atol=0), (table, field)
    assert fluid.GetNumberOfVerts() == len(rows), "a cell for each particle"


def main():
    index = pathlib.Path(sys.argv[1])
    moments = solids = 0
    for entry in xml.parse(index).getroot().iter("DataSet"):
        data = read(index.parent / entry.get("file"))
        if entry.get("name") == "fluid":
            check(data, (index.parent / entry.get("file")).with_suffix(".csv"))
            moments += 1
        elif entry.get("name") == "solids":
            assert data.GetNumberOfPolys() > 0, "triangles of solids"
            solids += 1
    assert moments > 0, "no moment of the fluid"
    print(f"{moments} moments of the fluid and {solids} of solids: the same values")


main()
