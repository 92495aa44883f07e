// The entry points of libFuzzer: oitlab_fuzz TARGET [options and folders of libFuzzer].
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "fuzz/targets.h"

namespace {
const std::function<void(std::string_view)>* target = nullptr;
}

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  static const oitlab::LowSceneLimits limits;
  const auto& targets = oitlab::fuzzTargets();
  const auto found = *argc > 1 ? targets.find((*argv)[1]) : targets.end();
  if (found == targets.end()) {
    std::fprintf(stderr, "usage: oitlab_fuzz TARGET [libFuzzer's options]; targets:");
    for (const auto& [name, parse] : targets) std::fprintf(stderr, " %s", name.c_str());
    std::fprintf(stderr, "\n");
    std::exit(2);
  }
  target = &found->second;
  // libFuzzer would take the name for a folder of inputs.
  for (int i = 1; i + 1 < *argc; ++i) (*argv)[i] = (*argv)[i + 1];
  --*argc;
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  (*target)({reinterpret_cast<const char*>(data), size});
  return 0;
}
