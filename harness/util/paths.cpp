#include "util/paths.h"

#include <cstdlib>

#include "util/error.h"

namespace oitlab {

std::filesystem::path dataRoot() {
  namespace fs = std::filesystem;
  std::error_code ignored;
  if (const char* root = std::getenv("OITLAB_ROOT"); root && *root) {
    if (!fs::is_directory(root, ignored))
      fail<InputError>("OITLAB_ROOT is '{}', expected a folder that exists", root);
    return root;
  }
  if (fs::path source = OITLAB_SOURCE_DIR; fs::is_directory(source, ignored)) return source;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  return ignored ? fs::path(".") : program.parent_path();
}

std::filesystem::path cacheRoot() {
  namespace fs = std::filesystem;
  auto variable = [](const char* name) -> fs::path {
    const char* value = std::getenv(name);
    return value ? value : "";
  };
  if (fs::path own = variable("OITLAB_CACHE"); !own.empty()) return own;
  if (fs::path xdg = variable("XDG_CACHE_HOME"); !xdg.empty()) return xdg / "oitlab";
  if (const fs::path home = variable("HOME"); !home.empty()) return home / ".cache" / "oitlab";
  std::error_code ignored;
  return fs::temp_directory_path(ignored) / "oitlab";
}

}  // namespace oitlab
