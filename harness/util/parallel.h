#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace oitlab {

/// Calls work(i) once for each i in [0, count), on all cores and in any order, and returns when all
/// calls have returned. After the first exception of `work` no more calls start, and the exception
/// is thrown again here. For preparation only, never while something is timed.
template <typename Work>
void parallelFor(std::size_t count, Work&& work) {
  std::atomic<std::size_t> next{0};
  std::exception_ptr error;
  std::mutex errorMutex;
  const auto run = [&] {
    for (std::size_t i; (i = next.fetch_add(1)) < count;) {
      try {
        work(i);
      } catch (...) {
        const std::lock_guard lock(errorMutex);
        if (!error) error = std::current_exception();
        next = count;
      }
    }
  };
  const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::jthread> helpers;
  for (std::size_t i = 1; i < std::min(cores, count); ++i) helpers.emplace_back(run);
  run();
  helpers.clear();  // joins
  if (error) std::rethrow_exception(error);
}

}  // namespace oitlab
