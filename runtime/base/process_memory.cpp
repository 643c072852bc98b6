#include "railtab/runtime/base/process_memory.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>  // defines __GLIBC__
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace railtab {

double resident_memory() noexcept {
  long pages = 0;
  std::FILE* const file = std::fopen("/proc/self/statm", "r");
  if (!file) return 0.0;
  const bool read = std::fscanf(file, "%*d %ld", &pages) == 1;
  std::fclose(file);
  return read ? static_cast<double>(pages) * static_cast<double>(sysconf(_SC_PAGESIZE)) : 0.0;
}

double peak_resident_memory() noexcept {
  constexpr double unit = 1024.0;  // of ru_maxrss on Linux
  rusage usage{};
  return getrusage(RUSAGE_SELF, &usage) == 0 ? unit * static_cast<double>(usage.ru_maxrss) : 0.0;
}

double installed_memory() noexcept {
  const long pages = sysconf(_SC_PHYS_PAGES);
  return pages > 0 ? static_cast<double>(pages) * static_cast<double>(sysconf(_SC_PAGESIZE)) : 0.0;
}

void return_large_pieces() noexcept {
#ifdef __GLIBC__
  // Every piece that goes back is paid for by page faults when it is asked for again: with a megabyte in place of what
  // the allocator allows at most, these took half of a run's set-up and its peak was the same.
  constexpr int large = 32 << 20, kept = 64 << 20;  // bytes
  mallopt(M_MMAP_THRESHOLD, large);
  mallopt(M_TRIM_THRESHOLD, kept);
#endif
}

void return_freed_memory() noexcept {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

}  // namespace railtab
