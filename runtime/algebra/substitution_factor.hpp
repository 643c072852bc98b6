#pragma once

#include <Eigen/Core>
#include <span>

#include "railtab/runtime/algebra/tree_path.hpp"

namespace railtab {

/// A factor L D Lᵀ of a system of equations whose two halves of a back-substitution are apart, and either can be
/// restricted to a path: what given unknowns hang on in the elimination tree, up to its roots. A load on the path
/// changes the forward half there only, and the backward half needs nothing else to give the solution there.
///
/// Vectors that the halves work on have room() entries in the factor's own order. Held unknowns are not touched.
class SubstitutionFactor {
 public:
  using Vector = Eigen::VectorXd;
  using Path = TreePath;

  virtual ~SubstitutionFactor() = default;

  [[nodiscard]] virtual Eigen::Index room() const noexcept = 0;
  /// What one half of a back-substitution reads [bytes].
  [[nodiscard]] virtual std::size_t bytes() const noexcept = 0;
  /// All that it keeps [bytes].
  [[nodiscard]] virtual std::size_t stored_bytes() const noexcept = 0;

  /// The same for this factor and its copies, another for every other factor: says whether a path is still of use.
  [[nodiscard]] long id() const noexcept { return id_; }

  /// Of unknowns, repeated ones are welcome.
  virtual void find_path(std::span<const int> unknowns, Path& path) const = 0;
  /// Whether a path that this factor found contains the paths of these unknowns. @pre they are the factor's
  [[nodiscard]] virtual bool covers(const Path& path, std::span<const int> unknowns) const = 0;
  virtual void into(const Vector& natural, Vector& ordered) const = 0;
  /// The same of a vector, times a weight. @pre it is zero at all unknowns but the few, of which repeated ones are
  /// welcome
  virtual void into(std::span<const int> few, double weight, const Vector& natural, Vector& ordered) const = 0;
  virtual void out_of(const Vector& ordered, Vector& natural) const = 0;
  /// A load times a weight; sets the entries on the path. @pre it is zero at all unknowns but the few, which are on it
  virtual void load(const Path& path, std::span<const int> few, double weight, const Vector& natural,
                    Vector& ordered) const = 0;
  /// Of a solution, few unknowns of the path.
  virtual void read(std::span<const int> few, const Vector& ordered, Vector& natural) const = 0;

  /// y <- L⁻¹ y.
  virtual void forward(Vector& y) const = 0;
  /// y <- (L⁻¹ y) + known on the path. @pre y is zero off it; known has been through forward()
  virtual void forward(Vector& y, const Path& path, const Vector& known) const = 0;
  /// The entries of L⁻ᵀ D⁻¹ y on the path; those of x elsewhere stay as they are.
  virtual void backward(const Vector& y, Vector& x, const Path& path) const = 0;
  /// The entries of L⁻ᵀ D⁻¹ y off the path, for an x that has those on it.
  virtual void backward_off(const Path& path, const Vector& y, Vector& x) const = 0;

  /// Full solution in the natural order, of all unknowns of the system; 0 where they are held.
  [[nodiscard]] Vector solve(const Vector& load) const;

 protected:
  SubstitutionFactor();
  SubstitutionFactor(const SubstitutionFactor&) = default;
  SubstitutionFactor(SubstitutionFactor&&) = default;
  SubstitutionFactor& operator=(const SubstitutionFactor&) = default;
  SubstitutionFactor& operator=(SubstitutionFactor&&) = default;

 private:
  long id_;
};

}  // namespace railtab
