#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <variant>

#include "railtab/runtime/contact/contact_search.hpp"
#include "railtab/runtime/contact/paper_search.hpp"
#include "railtab/runtime/contact/table_contact.hpp"
#include "railtab/tables/loaded_table.hpp"

namespace railtab {

/// Where the contact geometry of a run comes from: a geometry table (with its online fallback), the online search, or
/// the published method. Constant after construction; queries are const and thread-safe, those for patches free of
/// allocations.
class ContactGeometry {
 public:
  using Source = std::variant<TableContact, ContactSearch, PaperSearch>;
  /// @param loaded the loaded contact of the same pair, where forces come from it
  /// @param unused_error where forces do not come from it since it is too inaccurate: its certified error
  explicit ContactGeometry(Source source, std::shared_ptr<const LoadedTable> loaded = nullptr,
                           double unused_error = 0.0)
      : source_(std::move(source)), loaded_(std::move(loaded)), unused_error_(unused_error) {}

  /// Null where normal forces are those of the patches.
  [[nodiscard]] const LoadedTable* loaded() const noexcept { return loaded_.get(); }

  /// LoadedTableData::certified_force_error() of a loaded contact that is there and too inaccurate to be used; else 0.
  [[nodiscard]] double unused_loaded_error() const noexcept { return unused_error_; }

  /// Patches of the right wheel at a pose, with penetration above zero. Left wheel: pose.mirrored().
  [[nodiscard]] ContactPatches patches(const WheelsetPose& pose) const noexcept {
    return std::visit([&](const auto& source) { return source.patches(pose); }, source_);
  }

  /// Null where there is none.
  [[nodiscard]] const TableContact* table() const noexcept { return std::get_if<TableContact>(&source_); }
  [[nodiscard]] bool is_table() const noexcept { return table() != nullptr; }
  /// The online search in place of a table.
  [[nodiscard]] ContactGeometry without_table() const {
    return is_table() ? ContactGeometry(table()->search(), loaded_) : *this;
  }

  [[nodiscard]] const WheelRailPair& pair() const noexcept {
    return std::visit(
        [](const auto& source) -> const WheelRailPair& {
          if constexpr (requires { source.search(); }) {
            return source.search().pair();
          } else {
            return source.pair();
          }
        },
        source_);
  }

  /// Equivalent conicity at an amplitude [m] by the wave's length [EN15302]. Takes milliseconds; a further call for the
  /// same amplitude, of any thread, returns what the last one found. @returns none where there is no wave
  [[nodiscard]] std::optional<double> equivalent_conicity(double amplitude) const;

  /// The published method returns discretised pairs, which the common-normal Newton must not improve.
  [[nodiscard]] bool is_paper() const noexcept { return std::holds_alternative<PaperSearch>(source_); }

 private:
  struct LastConicity {
    std::mutex mutex;
    double amplitude = 0.0;  ///< none
    std::optional<double> value;
  };

  Source source_;
  std::shared_ptr<const LoadedTable> loaded_;
  double unused_error_;
  std::shared_ptr<LastConicity> last_conicity_ = std::make_shared<LastConicity>();
};

}  // namespace railtab
