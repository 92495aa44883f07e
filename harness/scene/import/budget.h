#pragma once

#include <cstdint>
#include <string>

namespace oitlab {

/// What one scene file may ask for. A file of some kilobytes can ask for terabytes.
struct SceneLimits {
  std::uint64_t texels = 1ull << 30;    ///< of all textures, decoded: 4 GiB
  std::uint64_t vertices = 1ull << 29;  ///< 16 GiB
  std::uint64_t bytes = 0;              ///< of textures, vertices and triangles in main memory

  /// The defaults, with half of the machine's main memory as `bytes`; each replaced by the
  /// environment variable OITLAB_SCENE_TEXELS, OITLAB_SCENE_VERTICES or OITLAB_SCENE_BYTES where it
  /// is set. Throws InputError where one is not a whole number above 0.
  static SceneLimits fromEnvironment();
};

/// The account of one scene file that is being read. Asked before memory is.
class SceneBudget {
 public:
  explicit SceneBudget(std::string file, SceneLimits limits = SceneLimits::fromEnvironment())
      : file_(std::move(file)), limits_(limits) {}

  /// Each throws InputError where the sum is beyond the limits: the file, `what` of it asks for
  /// too much, and how to allow it.
  void addTexels(std::uint64_t count, const std::string& what);
  void addVertices(std::uint64_t vertices, std::uint64_t triangles, const std::string& what);

 private:
  void addBytes(std::uint64_t count, const std::string& what);

  std::string file_;
  SceneLimits limits_;
  std::uint64_t texels_ = 0, vertices_ = 0, bytes_ = 0;
};

}  // namespace oitlab
