#pragma once

#include <utility>

#include "railtab/runtime/contact/contact_geometry.hpp"
#include "railtab/runtime/contact/frictionless_contact.hpp"
#include "railtab/runtime/contact_files/contact_table_file.hpp"

namespace railtab::python {

/// The contact geometry of a pair, whichever method finds it.
class Geometry {
 public:
  explicit Geometry(ContactGeometry contact) : contact_(std::move(contact)) {}
  virtual ~Geometry() = default;
  Geometry(const Geometry&) = delete;
  Geometry& operator=(const Geometry&) = delete;

  /// As those of vsi contact: a wheel that just touches has its patch.
  [[nodiscard]] virtual ContactPatches patches(const WheelsetPose& pose) const noexcept = 0;
  [[nodiscard]] virtual const ContactSearch& search() const noexcept = 0;
  [[nodiscard]] const ContactGeometry& contact() const noexcept { return contact_; }

 private:
  ContactGeometry contact_;
};

class TableGeometry : public Geometry {
 public:
  explicit TableGeometry(ContactTable table) : Geometry(std::move(table.geometry)), table_(std::move(table.patches)) {}
  [[nodiscard]] ContactPatches patches(const WheelsetPose& pose) const noexcept override {
    return table_.patches(pose, touch_rounding);
  }
  [[nodiscard]] const ContactSearch& search() const noexcept override { return table_.search(); }
  [[nodiscard]] const GeometryTable& table() const noexcept { return table_.table(); }

 private:
  TableContact table_;
};

class SearchGeometry : public Geometry {
 public:
  explicit SearchGeometry(ContactSearch search) : Geometry(ContactGeometry(search)), search_(std::move(search)) {}
  [[nodiscard]] ContactPatches patches(const WheelsetPose& pose) const noexcept override {
    return search_.patches(pose, touch_rounding);
  }
  [[nodiscard]] const ContactSearch& search() const noexcept override { return search_; }

 private:
  ContactSearch search_;
};

}  // namespace railtab::python
