#!/usr/bin/env python3
"""Checks the group VTKHDF of results against its specification, and its values against the results:
vtkhdf_of_results.py VSI

[VTKHDF file format, version 2.0: sections General Specification, Unstructured grid, Temporal data]
Ends with 77 (skipped) without python3-h5py. With python3-vtk9, VTK reads instants of it: VTK 9.1 as static grids of
version 1, VTK 9.3 or later the results themselves."""
import os
import subprocess
import sys
import tempfile

try:
    import h5py
    import numpy
except ImportError as missing:
    print(f"skipped: {missing} (Debian: python3-h5py)")
    sys.exit(77)
try:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkVersion
    from vtkmodules.vtkIOHDF import vtkHDFReader
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
    VTK = (vtkVersion.GetVTKMajorVersion(), vtkVersion.GetVTKMinorVersion())
except ImportError:
    VTK = None

sys.dont_write_bytecode = True
from drawn_scene import SCENE  # noqa: E402

PARTS = ("bridge", "rails", "bodies", "wheelsets")


def check_specification(group, instants):
    """Every point of the specification that an unstructured grid over time meets."""
    version = group.attrs.get_id("Version")
    assert version.shape == (2,) and version.dtype.kind == "i" and list(group.attrs["Version"]) == [2, 0]
    kind = group.attrs.get_id("Type")
    text = kind.get_type()
    assert isinstance(text, h5py.h5t.TypeStringID) and not text.is_variable_str() and kind.shape == ()
    assert text.get_cset() == h5py.h5t.CSET_ASCII and text.get_size() == len("UnstructuredGrid")
    assert group.attrs["Type"] == b"UnstructuredGrid"

    steps = group["Steps"]
    count = steps.attrs.get_id("NSteps")
    assert count.shape == () and count.dtype.kind == "i" and steps.attrs["NSteps"] == instants

    def integers(path, shape):
        data = group[path]
        assert data.dtype == numpy.int64 and data.shape == shape, (path, data.dtype, data.shape)
        return data[...]

    values = steps["Values"]
    assert values.dtype == numpy.float64 and values.shape == (instants,) and numpy.all(numpy.diff(values) > 0.0)
    parts, first_part = integers("Steps/NumberOfParts", (instants,)), integers("Steps/PartOffsets", (instants,))
    counts = [group[name] for name in ("NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds")]
    for data in counts:
        assert data.dtype == numpy.int64 and data.ndim == 1 and len(data) == parts.sum()
    points = integers("Steps/PointOffsets", (instants,))
    cells, corners = (integers(f"Steps/{name}Offsets", (instants, 1))[:, 0] for name in ("Cell", "ConnectivityId"))

    coordinates = group["Points"]
    assert coordinates.dtype == numpy.float32 and coordinates.ndim == 2 and coordinates.shape[1] == 3
    types = group["Types"]
    assert types.dtype == numpy.uint8 and types.ndim == 1, "VTK wants unsigned char"
    assert group["Offsets"].dtype == group["Connectivity"].dtype == numpy.int64
    assert set(group["PointData"]) == {"displacement", "recorded"} and set(group["CellData"]) == {"part"}
    assert group["PointData"].attrs["Vectors"] == b"displacement"
    for offsets in (points, cells, corners, first_part):
        assert offsets[0] == 0 and numpy.all(numpy.diff(offsets) >= 0), "offsets never fall"
    last_point = 0
    for t in range(instants):
        assert parts[t] == 1
        p, c, k = (int(data[first_part[t]]) for data in counts)
        assert points[t] == last_point, "instants lie one after the other, without gap"
        last_point = points[t] + p
        assert last_point <= len(coordinates) and cells[t] + c <= len(types)
        begin = cells[t] + first_part[t]  # each part has one offset more than cells
        offsets = group["Offsets"][begin:begin + c + 1]
        assert len(offsets) == c + 1 and offsets[0] == 0 and offsets[-1] == k and numpy.all(numpy.diff(offsets) > 0)
        connectivity = group["Connectivity"][corners[t]:corners[t] + k]
        assert len(connectivity) == k and connectivity.min() == 0 and connectivity.max() == p - 1
    assert last_point == len(coordinates), "no points that no instant names"
    for name, rows in (("displacement", 3), ("recorded", None)):
        data, offsets = group["PointData"][name], integers(f"Steps/PointDataOffsets/{name}", (instants,))
        assert data.shape[1:] == ((rows,) if rows else ())
        assert offsets[-1] + int(counts[0][0]) == len(data)
    assert group["PointData/displacement"].dtype == numpy.float32
    part, offsets = group["CellData/part"], integers("Steps/CellDataOffsets/part", (instants,))
    assert numpy.all(offsets == 0) and part.shape == types.shape, "stored once"
    storage = []
    group.visititems(lambda name, item: storage.append(item) if isinstance(item, h5py.Dataset) else None)
    for data in storage:
        assert data.compression is None and data.external is None and not data.is_virtual
        assert data.id.get_create_plist().get_nfilters() == 0, "readable by every HDF5"


def instant(group, t):
    """One instant as a reader puts it together from the offsets."""
    steps = group["Steps"]
    part, p0 = int(steps["PartOffsets"][t]), int(steps["PointOffsets"][t])
    c0, k0 = int(steps["CellOffsets"][t, 0]), int(steps["ConnectivityIdOffsets"][t, 0])
    p, c, k = (int(group[name][part]) for name in ("NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"))
    u0, r0 = (int(steps[f"PointDataOffsets/{name}"][t]) for name in ("displacement", "recorded"))
    n0 = int(steps["CellDataOffsets/part"][t])
    return {
        "Points": group["Points"][p0:p0 + p],
        "Connectivity": group["Connectivity"][k0:k0 + k],
        "Offsets": group["Offsets"][c0 + part:c0 + part + c + 1],
        "Types": group["Types"][c0:c0 + c],
        "PointData": {"displacement": group["PointData/displacement"][u0:u0 + p],
                      "recorded": group["PointData/recorded"][r0:r0 + p]},
        "CellData": {"part": group["CellData/part"][n0:n0 + c]},
    }


def points_of(grid, part):
    cells = numpy.flatnonzero(grid["CellData"]["part"] == PARTS.index(part))
    return numpy.unique(numpy.concatenate(
        [grid["Connectivity"][grid["Offsets"][c]:grid["Offsets"][c + 1]] for c in cells]))


def check_values(results, group, records):
    """Where a point is one of the results, it stands where they say, and moves as they say, to float32."""
    header = results["header"]
    assert numpy.array_equal(group["Steps/Values"], results["time"][records])
    names = [n.decode() for n in results["nodes/names"]]
    bodies = [n.decode() for n in results["bodies/names"]]
    nodes = numpy.stack([header["node_x"], header["node_y"], header["node_z"]], axis=1).astype(numpy.float32)
    largest = 0.0
    for t, record in enumerate(records):
        grid = instant(group, t)
        recorded = grid["PointData"]["recorded"] == 1
        moved = grid["PointData"]["displacement"]
        seen = set()
        for part, prefixes in (("bridge", ("deck",)), ("rails", ("rail-left", "rail-right"))):
            for point in points_of(grid, part):
                if not recorded[point]:
                    continue
                found = [i for i, name in enumerate(names)
                         if name.startswith(prefixes) and numpy.array_equal(nodes[i], grid["Points"][point])]
                assert len(found) == 1, grid["Points"][point]
                seen.add(found[0])
                expected = results["nodes/displacement"][record, found[0], :3].astype(numpy.float32)
                assert numpy.array_equal(moved[point], expected)
                largest = max(largest, abs(float(expected[2])))
        assert len(seen) == len(names) == 9, "every node is drawn"
        order = {"bodies": [i for i, b in enumerate(bodies) if "wheelset" not in b],
                 "wheelsets": [i for i, b in enumerate(bodies) if "wheelset" in b]}
        assert [len(order[part]) for part in order] == [3, 4]
        for part, indices in order.items():
            own = [point for point in points_of(grid, part) if recorded[point]]
            assert len(own) == len(indices)
            for point, body in zip(own, indices):
                place = numpy.array([results["position"][record] + header["body_x"][body], header["body_y"][body],
                                     header["body_z"][body]])
                assert numpy.array_equal(grid["Points"][point], place.astype(numpy.float32))
                expected = results["bodies/displacement"][record, body, :3].astype(numpy.float32)
                assert numpy.array_equal(moved[point], expected)
    assert largest > 1e-6, "the bridge moves"


def compare(grid, data, place):
    assert data.GetNumberOfPoints() == len(grid["Points"]), place
    assert numpy.array_equal(vtk_to_numpy(data.GetPoints().GetData()), grid["Points"]), place
    assert numpy.array_equal(vtk_to_numpy(data.GetCellTypesArray()), grid["Types"]), place
    assert numpy.array_equal(vtk_to_numpy(data.GetCells().GetConnectivityArray()), grid["Connectivity"]), place
    assert numpy.array_equal(vtk_to_numpy(data.GetCells().GetOffsetsArray()), grid["Offsets"]), place
    for values, kind in ((data.GetPointData(), "PointData"), (data.GetCellData(), "CellData")):
        for name, expected in grid[kind].items():
            assert numpy.array_equal(vtk_to_numpy(values.GetArray(name)), expected), (place, name)


def read_static_in_vtk(grid):
    """The instant in a file of version 1, which every VTK with a reader of the format reads."""
    with h5py.File("static.hdf", "w") as out:
        group = out.create_group("VTKHDF")
        group.attrs["Version"] = numpy.array([1, 0])
        group.attrs.create("Type", b"UnstructuredGrid", dtype=h5py.string_dtype("ascii", 16))
        group["NumberOfPoints"] = numpy.array([len(grid["Points"])])
        group["NumberOfCells"] = numpy.array([len(grid["Types"])])
        group["NumberOfConnectivityIds"] = numpy.array([len(grid["Connectivity"])])
        for name in ("Points", "Connectivity", "Offsets", "Types"):
            group[name] = grid[name]
        for kind in ("PointData", "CellData"):
            for name, values in grid[kind].items():
                group[f"{kind}/{name}"] = values
    reader = vtkHDFReader()
    reader.SetFileName("static.hdf")
    assert reader.CanReadFile("static.hdf")
    reader.Update()
    return reader.GetOutput()


def read_parts(frame):
    """What vsi export writes of the same record, part by part."""
    for part in PARTS:
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(f"run/{part}-{frame:05}.vtu")
        reader.Update()
        data = reader.GetOutput()
        yield (vtk_to_numpy(data.GetPoints().GetData()), vtk_to_numpy(data.GetPointData().GetArray("displacement")),
               vtk_to_numpy(data.GetCellTypesArray()))


def check_in_vtk(vsi, file, group):
    times = group["Steps/Values"][...]
    listed = ",".join(repr(float(time)) for time in times)
    subprocess.run([vsi, "export", file, "-o", "run.pvd", "--times", listed, "--scale", "0", "-q"], check=True)
    for t in range(len(times)):
        grid = instant(group, t)
        compare(grid, read_static_in_vtk(grid), f"instant {t}")
        for found, values in zip(zip(*read_parts(t)), (grid["Points"], grid["PointData"]["displacement"],
                                                       grid["Types"])):
            assert numpy.array_equal(numpy.concatenate(found), values), "the geometry of vsi export"
    if VTK < (9, 3):
        return "single instants in VTK {}.{}, which reads version 1".format(*VTK)
    reader = vtkHDFReader()
    reader.SetFileName(file)
    reader.UpdateInformation()
    assert reader.GetNumberOfSteps() == len(times)
    for t in range(len(times)):
        reader.SetStep(t)
        reader.Update()
        compare(instant(group, t), reader.GetOutput(), f"step {t}")
    return "the results in VTK {}.{}".format(*VTK)


def main():
    vsi = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)

        def run(name, output):
            with open(f"{name}.toml", "w") as scene:
                scene.write(SCENE + "[output]\n" + output)
            subprocess.run([vsi, "run", f"{name}.toml", "-o", f"{name}.h5", "-q"], check=True)
            return h5py.File(f"{name}.h5")

        read_by = "nothing: python3-vtk9 is absent"
        for name, output, records in (("all", "", list(range(21))),
                                      ("few", "paraview_instants = 5\n", [0, 8, 16, 20])):
            results = run(name, output)
            check_specification(results["VTKHDF"], len(records))
            check_values(results, results["VTKHDF"], records)
            if VTK:
                read_by = check_in_vtk(vsi, f"{name}.h5", results["VTKHDF"])
        assert "VTKHDF" not in run("none", "paraview_instants = 0\n")
        assert "VTKHDF" not in run("still", "bodies = []\nnodes = []\n"), "nothing is recorded that moves"
        with run("bodies", "nodes = []\nwheels = false\n") as results:
            check_specification(results["VTKHDF"], 21)
    print(f"VTKHDF 2.0 as specified; displacements equal the results to float32; read back: {read_by}")


main()
