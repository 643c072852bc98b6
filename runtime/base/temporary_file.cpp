#include "railtab/runtime/base/temporary_file.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "railtab/runtime/base/writer_lock.hpp"

namespace railtab {

namespace {

std::atomic<unsigned> names_given{0};

/// What the names of this host's temporary files of `file` begin with.
std::string beginning(const std::filesystem::path& file) {
  constexpr std::size_t longest = 32;  // a file's name has a limit too
  std::array<char, 256> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) host[0] = '\0';
  return fmt::format("{}.part-{}-", file.filename().string(), std::string_view(host.data()).substr(0, longest));
}

struct Owner {
  pid_t process = 0;
  unsigned number = 0;
};

/// "<process>-<n>" and nothing else.
std::optional<Owner> owner(std::string_view text) {
  Owner found;
  const char* const end = text.data() + text.size();
  const auto process = std::from_chars(text.data(), end, found.process);
  if (process.ec != std::errc{} || found.process <= 0 || process.ptr == end || *process.ptr != '-') return {};
  const auto number = std::from_chars(process.ptr + 1, end, found.number);
  if (number.ec != std::errc{} || number.ptr != end) return {};
  return found;
}

bool is_gone(const Owner& owner) noexcept {
  // a process of the same number before this one, as in containers, where numbers begin anew
  if (owner.process == ::getpid()) return owner.number >= names_given;
  return ::kill(owner.process, 0) != 0 && errno == ESRCH;
}

}  // namespace

std::filesystem::path temporary_name(const std::filesystem::path& file) {
  return file.parent_path() / fmt::format("{}{}-{}", beginning(file), ::getpid(), names_given++);
}

void remove_abandoned(const std::filesystem::path& file) {
  const std::string begin = beginning(file);
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  std::error_code failed;
  std::vector<std::filesystem::path> abandoned;
  for (std::filesystem::directory_iterator entry(folder, failed), end; !failed && entry != end;
       entry.increment(failed)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with(begin)) continue;
    const std::optional<Owner> who = owner(std::string_view(name).substr(begin.size()));
    if (who && is_gone(*who)) abandoned.push_back(entry->path());
  }
  for (const std::filesystem::path& name : abandoned) {
    const WriterLock lock = WriterLock::if_free(name);
    if (lock.held()) std::filesystem::remove(name, failed);
  }
}

}  // namespace railtab
