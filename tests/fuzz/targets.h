#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "support/environment.h"

namespace oitlab {

/// Limits of a scene while it lives: some megabytes, so that an input that asks for more is refused
/// at once and the fuzzer goes on.
struct LowSceneLimits {
  ScopedEnvironment texels{"OITLAB_SCENE_TEXELS", "1000000"};
  ScopedEnvironment vertices{"OITLAB_SCENE_VERTICES", "100000"};
  ScopedEnvironment bytes{"OITLAB_SCENE_BYTES", "100000000"};
};

/// The parsers of bytes that may come from a stranger or from a damaged disk, by the name of what
/// they read. A target takes any bytes. It returns when they were read or refused with an
/// InputError. Whatever else happens is a fault: another exception, a signal, a report of a
/// sanitizer, or std::logic_error when the result is wrong.
const std::map<std::string, std::function<void(std::string_view)>>& fuzzTargets();

/// A folder of this process for files that parsers read by their path. It is removed at the end.
const std::filesystem::path& fuzzFolder();

/// Calls `parse`. An InputError is a refusal, which is fine.
void parseOrRefuse(const std::function<void()>& parse);

// The targets, in files by package.
void fuzzGltf(std::string_view bytes);
void fuzzObj(std::string_view bytes);
void fuzzTexture(std::string_view bytes);
void fuzzPng(std::string_view bytes);
void fuzzExr(std::string_view bytes);
void fuzzExperiment(std::string_view bytes);
void fuzzCell(std::string_view bytes);
void fuzzSpirvCache(std::string_view bytes);
void fuzzQuadCache(std::string_view bytes);

}  // namespace oitlab
