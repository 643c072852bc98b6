#include "railtab/runtime/base/temporary_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <random>
#include <string_view>
#include <vector>

#include "railtab/runtime/base/input_error.hpp"

namespace railtab {

namespace {

constexpr std::string_view alphabet = "abcdefghijklmnopqrstuvwxyz234567";
constexpr std::size_t suffix_length = 12;

std::string random_suffix() {
  std::random_device random;
  std::uniform_int_distribution<std::size_t> any(0, alphabet.size() - 1);
  std::string suffix;
  while (suffix.size() < suffix_length) suffix += alphabet[any(random)];
  return suffix;
}

/// The output whose temporary file has this name; empty where it is no such name.
std::string output_of(std::string_view name) {
  if (name.size() <= temporary_mark.size() + suffix_length) return {};
  const std::string_view suffix = name.substr(name.size() - suffix_length);
  name.remove_suffix(suffix_length);
  const auto known = [](char c) { return alphabet.find(c) != std::string_view::npos; };
  if (!name.ends_with(temporary_mark) || !std::all_of(suffix.begin(), suffix.end(), known)) return {};
  return std::string(name.substr(0, name.size() - temporary_mark.size()));
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
}

[[noreturn]] void reject(const std::filesystem::path& file, int error) {
  if (error == ENOSPC || error == EDQUOT || error == EIO || error == EMFILE || error == ENFILE) {
    throw ComputationError(fmt::format("{}: could not be written: {}", file.string(), std::strerror(error)));
  }
  throw input_error(file.string(), fmt::format("a place that cannot be written ({})", std::strerror(error)),
                    "a file name in an existing folder that can be written");
}

}  // namespace

TemporaryFile::~TemporaryFile() {
  std::error_code ignored;
  if (!name.empty()) std::filesystem::remove(name, ignored);
}

void TemporaryFile::publish(const std::filesystem::path& file) {
  // To the disk itself, so that the new name never stands for a file that a power failure emptied. Some file systems
  // find only here that they are full; others cannot do it.
  if (::fsync(lock.descriptor()) != 0 && (errno == EIO || errno == ENOSPC || errno == EDQUOT)) reject(file, errno);
  std::error_code failed;
  std::filesystem::rename(name, file, failed);
  if (failed) throw input_error(file.string(), failed.message(), "a file that can be replaced");
  name.clear();
  const int folder = ::open(folder_of(file).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder >= 0) {
    ::fsync(folder);
    ::close(folder);
  }
}

TemporaryFile create_temporary(const std::filesystem::path& file) {
  remove_abandoned(file);
  constexpr int most_names = 1000;  // one that is taken, or that a remover takes away before it is locked, is rare
  for (int i = 0; i < most_names; ++i) {
    const std::filesystem::path name = fmt::format("{}{}{}", file.string(), temporary_mark, random_suffix());
    constexpr int everybody = 0666;  // cut by the umask, as for every new file
    const int descriptor = ::open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, everybody);
    if (descriptor < 0 && errno == EEXIST) continue;
    if (descriptor < 0) reject(file, errno);
    WriterLock lock = WriterLock::of_descriptor(descriptor);
    struct stat state {};
    if (lock.held() && ::fstat(descriptor, &state) == 0 && state.st_nlink > 0) return {name, std::move(lock)};
  }
  throw ComputationError(fmt::format("{}: no name for a temporary file beside it", file.string()));
}

void remove_abandoned(const std::filesystem::path& file) {
  remove_abandoned_in(folder_of(file),
                      [output = file.filename().string()](const std::string& of) { return of == output; });
}

void remove_abandoned_in(const std::filesystem::path& folder,
                         const std::function<bool(const std::string&)>& is_output) {
  std::error_code failed;
  std::vector<std::filesystem::path> temporaries;
  for (std::filesystem::directory_iterator entry(folder, failed), end; !failed && entry != end;
       entry.increment(failed)) {
    const std::string output = output_of(entry->path().filename().string());
    if (!output.empty() && is_output(output)) temporaries.push_back(entry->path());
  }
  for (const std::filesystem::path& name : temporaries) {
    const WriterLock lock = WriterLock::if_free(name);
    if (lock.held()) std::filesystem::remove(name, failed);
  }
}

}  // namespace railtab
