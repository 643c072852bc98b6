#pragma once

#include <string>

namespace railtab::work_precision {

/// Kind of processor and its number of cores, as the system says it, no name of a host.
[[nodiscard]] std::string machine_kind();

/// Commit of the source tree, "-dirty" where files are changed that runs depend on; "unknown" outside a repository.
[[nodiscard]] std::string source_commit();

}  // namespace railtab::work_precision
