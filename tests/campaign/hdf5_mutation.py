"""Changes of HDF5 files by h5py that leave them HDF5: shapes, types, numbers, names, links; with checksums that agree
with what was changed, as a program that writes such files would make them, or without.
"""

import contextlib
import io
import warnings

import h5py
import numpy

mask = (1 << 64) - 1
seed = 14695981039346656037
prime = 1099511628211
extremes = [0.0, -1.0, float("nan"), float("inf"), 1e300, -1e300, 1e-300, 2.0**53, 1e9, -0.0]


def fnv(content, sum=seed):
    """FNV-1a over bytes."""
    for byte in content:
        sum = ((sum ^ byte) * prime) & mask
    return sum


def word_checksum(content, sum=seed):
    """That of results and seals: eight bytes at a time."""
    content = content + bytes(-len(content) % 8)
    for word in numpy.frombuffer(content, "<u8").tolist():
        sum = ((sum ^ word) * prime) & mask
        sum ^= sum >> 32
    return sum


def signed(sum):
    return sum - (1 << 64) if sum >= 1 << 63 else sum


def without_seal(file):
    """The bytes of a sealed file as another program would write them."""
    target = io.BytesIO()
    with h5py.File(file) as source, h5py.File(target, "w", libver="latest", track_order=True) as copy:
        def take(from_group, to_group):
            for name, value in from_group.attrs.items():
                to_group.attrs.create(name, value)
            for name, item in from_group.items():
                if isinstance(item, h5py.Group):
                    take(item, to_group.create_group(name, track_order=True))
                else:
                    source.copy(item, to_group, name)
        take(source, copy)
    return target.getvalue()


def numbers_of(values):
    return numpy.asarray(values, "<f8").tobytes()


def geometry_checksum(table):
    """docs/file_formats/geometry_table.md."""
    sum = seed

    def add(content, count):
        nonlocal sum
        sum = fnv(content, fnv(numbers_of([float(count)]), sum))

    for side in ("wheel", "rail"):
        for name in ("s", "y", "z", "dy", "dz"):
            values = table[f"profiles/{side}/{name}"][()]
            add(numbers_of(values), values.size)
    for axis in ("lateral", "yaw_squared", "roll"):
        values = [*table[f"axes/{axis}"][()], float(table[f"axes/{axis}"].attrs["cells"])]
        add(numbers_of(values), len(values))
    cells = table["cells"]
    add(numbers_of([cells.attrs["shard_index"], cells.attrs["shard_count"]]), 2)
    for name, kind in (("cells/node", "<u4"), ("cells/leaf_branches", "<u4"), ("cells/trusted_lowering", "<f4"),
                       ("branches/coefficient", "<f4")):
        values = table[name][()].astype(kind)
        add(values.tobytes(), values.size)
    for name in ("track_gauge", "gauge_height", "flange_back", "nominal_radius", "tolerance"):
        add(numbers_of([table[f"dimensions/{name}"][()]]), 1)
    for value in statistics_of(table):
        add(numbers_of([value]), 1)
    if "loaded" in table:
        loaded = table["loaded"]
        for name in ("lateral", "roll", "yaw_squared", "cut", "shift", "touch"):
            values = loaded[name][()].astype("f8") if name in loaded else numpy.zeros(0)
            add(values.tobytes(), values.size)
        add(numbers_of([loaded.attrs[name] for name in ("levels", "largest_level", "contact_modulus")]), 3)
        if loaded.attrs.get("climb", 0.0) != 0.0:
            add(numbers_of([loaded.attrs["climb"]]), 1)
        for value in statistics_of(loaded):
            add(numbers_of([value]), 1)
        for name, kind in (("height", "<f4"), ("pressed", "<u4"), ("part", "<f4")):
            sum = fnv(loaded[name][()].astype(kind).tobytes(), sum)
    return f"{sum:016x}"


def statistics_of(group):
    attributes = group["statistics"].attrs
    return [attributes[name] for name in attributes]


def creep_checksum(table):
    """docs/file_formats/creep_table.md, of the default layout."""
    sum = seed
    options = table["options"].attrs
    for name in ("axes/ratio", "axes/t", "axes/alpha", "axes/beta", "values"):
        values = table[name][()].astype("f8")
        sum = fnv(values.tobytes(), fnv(numbers_of([float(values.size)]), sum))
    values = [options[name] for name in ("poisson", "elements", "ratio_stretch", "radius_unit")]
    sum = fnv(numbers_of(values), fnv(numbers_of([4.0]), sum))
    for value in statistics_of(table):
        sum = fnv(numbers_of([value]), fnv(numbers_of([1.0]), sum))
    return f"{sum:016x}"


def reseal_table(table):
    kind = table.attrs["filetype"]
    sum = geometry_checksum(table) if b"geometry" in bytes(kind) else creep_checksum(table)
    table.attrs.modify("checksum", numpy.bytes_(sum))


def reseal_results(results):
    """Checksums of what does not grow, and of the blocks of what does."""
    blocks = results["block_checksums"]
    stored = blocks[()]
    ends = [int(row[0]) & mask for row in stored.astype("u8")]

    def visit(name, item):
        if not isinstance(item, h5py.Dataset) or name == "block_checksums":
            return
        if "checksum" in item.attrs:
            item.attrs.modify("checksum", numpy.int64(signed(word_checksum(numpy.asarray(item[()]).tobytes()))))
        elif "checksum_column" in item.attrs:
            begin = 0
            for row, end in enumerate(ends):
                column = int(item.attrs["checksum_column"])
                if end <= item.shape[0] and 0 < column < stored.shape[1]:
                    stored[row, column] = numpy.array(word_checksum(item[begin:end].tobytes()),
                                                      "u8").astype(stored.dtype)
                begin = end

    results.visititems(visit)
    blocks[...] = stored


def paths_of(file):
    groups, datasets = [""], []
    file.visititems(lambda name, item: (datasets if isinstance(item, h5py.Dataset) else groups).append(name))
    return groups, datasets


def replace(random, file, name, values):
    """The dataset made anew with these values, with its attributes."""
    attributes = dict(file[name].attrs)
    del file[name]
    form = random.choice(({}, {}, {"chunks": True}, {"chunks": True, "compression": "gzip"}))
    if numpy.ndim(values) == 0:
        form = {}
    try:
        new = file.create_dataset(name, data=values, **form)
    except (TypeError, ValueError):
        new = file.create_dataset(name, data=values)
    for key, value in attributes.items():
        new.attrs[key] = value


def change_number(random, file, groups, datasets):
    name = random.choice(datasets)
    values = numpy.array(file[name][()])
    if values.size == 0 or values.dtype.kind not in "fiu":
        return change_text(random, file, groups, datasets)
    flat = values.reshape(-1)
    for _ in range(random.choice((1, 1, 1, 3))):
        at = random.randrange(flat.size)
        new = random.choice((*extremes, float(flat[at]) * 1.001, -float(flat[at]), float(flat[at]) * 1e6))
        if values.dtype.kind in "iu":
            limits = numpy.iinfo(values.dtype)
            new = random.choice((limits.min, limits.max, 0, 1, 2, 7, limits.max // 2))
        with numpy.errstate(all="ignore"):
            flat[at] = new
    file[name][...] = values.reshape(file[name].shape)


def change_text(random, file, groups, datasets):
    texts = [name for name in datasets if file[name].dtype.kind in "SO"]
    if not texts:
        return change_attribute(random, file, groups, datasets)
    name = random.choice(texts)
    shape = file[name].shape
    text = random.choice((b"", b"x", b"\x1b[31m", b"\xff\xfe", b"<script>", b"a" * 5000, b"deck"))
    replace(random, file, name, numpy.full(shape, text, dtype=f"S{max(1, len(text))}"))


def change_shape(random, file, groups, datasets):
    name = random.choice(datasets)
    values = numpy.array(file[name][()])
    acts = [lambda v: v.reshape(-1)[:0], lambda v: v.reshape(-1)[:1], lambda v: v[None], lambda v: v.reshape(-1),
            lambda v: numpy.concatenate([v.reshape(-1)] * 3), lambda v: v[..., :-1] if v.ndim else v,
            lambda v: v[:-1] if v.ndim else v, lambda v: numpy.resize(v, (1,) * 8), lambda v: v.T,
            lambda v: numpy.resize(v, (1000,) + v.shape[1:])]
    replace(random, file, name, random.choice(acts)(values))


def change_type(random, file, groups, datasets):
    name = random.choice(datasets)
    values = numpy.array(file[name][()])
    kind = random.choice(("f4", "f8", ">f8", "i1", "i4", "u8", "S3", "?", "c16"))
    with numpy.errstate(all="ignore"):
        try:
            values = values.astype(kind)
        except ValueError:
            values = numpy.zeros(values.shape, kind)
    replace(random, file, name, values)


def delete(random, file, groups, datasets):
    del file[random.choice([*datasets, *groups[1:]])]


def change_attribute(random, file, groups, datasets):
    holders = [file[name] if name else file for name in [*groups, *datasets]]
    item = random.choice([holder for holder in holders if len(holder.attrs)])
    name = random.choice(list(item.attrs))
    if random.random() < 0.3:
        del item.attrs[name]
        return
    item.attrs[name] = random.choice((*extremes, numpy.int64(-1), numpy.int64(2**62), numpy.int64(0), b"", b"x",
                                      b"\x1b[0m" * 20, "a" * 3000, numpy.zeros(3), numpy.zeros((0,))))


def change_link(random, file, groups, datasets):
    name = random.choice(datasets)
    act = random.choice(("soft", "loop", "external", "group", "hard", "virtual"))
    other = random.choice(datasets)
    del file[name]
    if act == "soft":
        file[name] = h5py.SoftLink("/" + other)
    elif act == "loop":
        file[name] = h5py.SoftLink("/" + name)
    elif act == "external":
        file[name] = h5py.ExternalLink("pair.h5", "/profiles/wheel/s")
    elif act == "group":
        file.create_group(name)
    elif act == "hard":
        file[name] = file[random.choice([known for known in datasets if known != name])]
    else:
        layout = h5py.VirtualLayout(shape=(3,), dtype="f8")
        layout[:] = h5py.VirtualSource("pair.h5", "profiles/wheel/s", shape=(3,))
        file.create_virtual_dataset(name, layout)


warnings.simplefilter("ignore")  # casts lose what they cannot keep
acts = [change_number] * 6 + [change_text, change_shape, change_shape, change_type, delete, change_attribute,
                              change_attribute, change_link]


def mutate_hdf5(random, content):
    """A file with one to three changes, and their names."""
    stream = io.BytesIO(content)
    done = []
    with h5py.File(stream, "r+", libver="latest") as file:
        for _ in range(random.choice((1, 1, 1, 2, 3))):
            act = random.choice(acts)
            groups, datasets = paths_of(file)
            if not datasets:
                break
            with contextlib.suppress(OSError, TypeError, ValueError, KeyError):  # what an earlier change forbids
                act(random, file, groups, datasets)
                done.append(act.__name__)
        if random.random() < 0.75:
            try:
                (reseal_results if "records" in file else reseal_table)(file)
                done.append("resealed")
            except (KeyError, ValueError, TypeError, AttributeError, IndexError, OverflowError, OSError, RuntimeError,
                    MemoryError):
                done.append("seal broken")  # what is left has no place for it
    return stream.getvalue(), "+".join(done)
