#pragma once

#include <cstddef>
#include <functional>

namespace railtab {

/// Runs task(0) … task(count − 1), each once, on up to `threads` threads, this one among them. An exception of a task
/// ends the others' search for more, and the one of the lowest number is thrown. @pre threads >= 1
void share_work(std::size_t count, int threads, const std::function<void(std::size_t)>& task);

}  // namespace railtab
