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
  if (const fs::path source = OITLAB_SOURCE_DIR; fs::is_directory(source, ignored)) return source;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  return ignored ? fs::current_path() : program.parent_path();
}

}  // namespace oitlab
