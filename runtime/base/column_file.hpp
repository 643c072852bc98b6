#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace railtab {

/// One column of a text file: the header cell "Fy[kN]" has the name "Fy" and the unit "kN".
struct FileColumn {
  std::string name, unit;
  std::vector<double> values;  ///< as written, in the unit of the header
  /// Where a cell of this column stands, "file:line: column name". Row 0 is the header.
  [[nodiscard]] std::string place(std::size_t row) const;

  std::string file;
  std::vector<long> line;  ///< of the header and of every row
};

/// Read a text file of numbers: comment lines "#", one header row "name[unit],…", then rows of as many finite numbers,
/// the first column strictly increasing, at least two rows (docs/file_formats/histories.md).
/// @param example of a header row, for messages @throws InputError with file and line
[[nodiscard]] std::vector<FileColumn> read_columns(const std::filesystem::path& file, std::string_view example = {});

/// "columns t, v", for messages.
[[nodiscard]] std::string names_of(const std::vector<FileColumn>& columns);

/// Numbers under a header row of names, the columns in the order in which they were asked for.
struct NumberRows {
  std::vector<std::vector<double>> rows;
  std::vector<std::string> places;  ///< of the rows, "file:line"
};

/// Read a text file whose header row has exactly these names, in any order, and at least one row of as many finite
/// numbers under them. @throws InputError with file and line
[[nodiscard]] NumberRows read_number_rows(const std::filesystem::path& file, const std::vector<std::string>& columns);

/// Whether the header row has this name. @throws InputError where the file cannot be read
[[nodiscard]] bool has_column(const std::filesystem::path& file, std::string_view name);

/// Factor from the column's unit to SI.
struct UnitFactor {
  std::string_view unit;
  double factor;
};
/// @throws InputError naming the header cell and the units known
[[nodiscard]] double factor_to_si(const FileColumn& column, const std::vector<UnitFactor>& units);

/// Rejects values that are off by orders of magnitude, most likely of another unit than the header says.
/// @param limit on the amount of the column's values times `factor`, in SI units @throws InputError naming the line
void require_magnitude(const FileColumn& column, double factor, double limit);

/// Rejects times and places, in SI units already, beyond ±10⁹ and neighbours nearer than 10⁻⁹: differences between them
/// must be numbers to divide by. @throws InputError naming the line
void require_argument(const FileColumn& column);

}  // namespace railtab
