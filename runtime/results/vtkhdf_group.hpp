#pragma once

#include <span>

#include "railtab/runtime/drawing/moving_grid.hpp"
#include "railtab/tables/files/array_file.hpp"

/// The group "VTKHDF" of a results file: the moving grid of a run, which ParaView opens [VTKHDF file format, version
/// 2.0: temporal unstructured grid]. Its attribute Type says what it is once all is written.
namespace railtab::vtkhdf {

/// All of it, empty, before the records begin.
void create(ArrayFileWriter& out);
[[nodiscard]] bool is_in(const ArrayFileReader& in);
/// That nothing in it is valid: what a run that is resumed had written when it ended.
void invalidate(ArrayFileWriter& out);
/// @param grid at least one instant. After the last record; nothing can be appended after it.
void write(ArrayFileWriter& out, const drawing::MovingGrid& grid);
/// Shapes, offsets, numbers of points and cells, and that all instants are those of records.
/// @param steps records of the file
/// @throws InputError with file, dataset, found and expected
void check(const ArrayFileReader& in, std::span<const StepRecord> steps);

/// Bytes of a file [bytes]. @param instants 0: the empty group
[[nodiscard]] double file_bytes(const drawing::MovingGridSize& size, double instants);
/// Of memory, while it is written.
[[nodiscard]] double memory_bytes(const drawing::MovingGridSize& size, double instants);

}  // namespace railtab::vtkhdf
