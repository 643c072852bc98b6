#!/usr/bin/env python3
"""Opens an export of vsi in VTK and compares it with the results: export_in_vtk.py VSI

Ends with 77 (skipped) without python3-vtk9, python3-h5py or numpy."""
import os
import subprocess
import sys
import tempfile

try:
    import h5py
    import numpy
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
except ImportError as missing:
    print(f"skipped: {missing} (Debian: python3-vtk9, python3-h5py)")
    sys.exit(77)

sys.dont_write_bytecode = True
from drawn_scene import SCENE  # noqa: E402


def read(file):
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(file)
    reader.Update()
    assert reader.GetErrorCode() == 0, file
    return reader.GetOutput()


def array(data, name):
    found = data.GetArray(name)
    assert found is not None, f"no array {name}"
    return vtk_to_numpy(found)


def main():
    vsi = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        with open("s.toml", "w") as scene:
            scene.write(SCENE)
        subprocess.run([vsi, "run", "s.toml", "-o", "r.h5", "-q"], check=True)
        subprocess.run([vsi, "export", "r.h5", "-o", "run.pvd", "--every", "0.01", "--scale", "10", "-q"], check=True)
        results = h5py.File("r.h5")
        for frame, record in enumerate((0, 10, 20)):
            nodes = read(f"run/nodes-{frame:05}.vtu")
            recorded = results["nodes/displacement"][record]
            assert nodes.GetNumberOfPoints() == len(recorded) == 9
            found = array(nodes.GetPointData(), "displacement")
            assert found.dtype == numpy.float32
            assert numpy.array_equal(found, recorded[:, :3].astype(numpy.float32))
            x = vtk_to_numpy(nodes.GetPoints().GetData())[:, 0] - 10.0 * found[:, 0]
            assert numpy.allclose(x, results["header/node_x"][:], rtol=0.0, atol=1e-5)
            assert array(nodes.GetFieldData(), "TimeValue")[0] == results["time"][record]
            assert array(nodes.GetFieldData(), "displacement_scale")[0] == 10.0
            names = nodes.GetFieldData().GetAbstractArray("node_names")
            assert [names.GetValue(i) for i in range(9)] == [n.decode() for n in results["nodes/names"][:]]

            forces = read(f"run/contact_forces-{frame:05}.vtu")
            expected = numpy.stack([results[f"wheels/{f}"][record] for f in "XYQ"], axis=1).astype(numpy.float32)
            assert numpy.array_equal(array(forces.GetPointData(), "force"), expected)

            bodies = read(f"run/bodies-{frame:05}.vtu")
            assert bodies.GetNumberOfCells() == 6, "a point and a box of a car body and two bogies"
            boxes = [numpy.array(bodies.GetCell(i).GetBounds()) for i in range(6) if bodies.GetCellType(i) == 12]
            assert len(boxes) == 3
            low, high = boxes[0].reshape(3, 2).T
            assert numpy.all(high - low > 1.0), "a car body has length, width and height"

            bridge = read(f"run/bridge-{frame:05}.vtu")
            assert array(bridge.GetPointData(), "recorded").sum() == 3
            for part in ("rails", "wheelsets"):
                assert read(f"run/{part}-{frame:05}.vtu").GetNumberOfCells() > 0
    print("18 files opened in VTK; displacements and forces equal the results to float32")


main()
