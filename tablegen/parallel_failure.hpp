#pragma once

#include <atomic>
#include <exception>

namespace railtab {

/// What the threads of a parallel region throw, which must not leave it: the first exception ends the others' search
/// for more work and is thrown again behind the region.
class ParallelFailure {
 public:
  /// Calls work(), unless something has failed.
  template <class Work>
  void guard(const Work& work) noexcept {
    if (failed_) return;
    try {
      work();
    } catch (...) {
      if (!failed_.exchange(true)) error_ = std::current_exception();
    }
  }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::atomic<bool> failed_ = false;
  std::exception_ptr error_;
};

}  // namespace railtab
