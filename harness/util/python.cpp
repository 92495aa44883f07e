#include "util/python.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>

#include <fmt/format.h>

#include "util/paths.h"
#include "util/suggest.h"

namespace oitlab {
namespace {

/// Runs a program whose output goes where ours does, or nowhere. Returns its exit code, or 127.
int runCommand(const std::vector<std::string>& arguments, bool quiet) {
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (quiet)
    for (const int stream : {1, 2})
      posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int error = posix_spawnp(&child, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return 127;
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

}  // namespace

std::vector<std::string> pythonCandidates() {
  if (const char* given = std::getenv("OITLAB_PYTHON"); given && *given) return {given};
  return {"python3", "/usr/bin/python3", "python"};
}

std::optional<std::string> findPython(const std::vector<std::string>& modules) {
  const std::vector<std::string> candidates = pythonCandidates();
  for (const std::string& python : candidates) {
    if (runCommand({python, "-c", "import " + joinNames(modules)}, true) != 0) continue;
    if (python != candidates.front())
      fmt::print(stderr, "using {}: {} lacks one of {}\n", python, candidates.front(),
                 joinNames(modules));
    return python;
  }
  return std::nullopt;
}

int runAnalysis(const std::string& python, const std::vector<std::string>& arguments) {
  std::string path = (dataRoot() / "analysis").string();
  if (const char* before = std::getenv("PYTHONPATH"); before && *before)
    path += std::string(":") + before;
  setenv("PYTHONPATH", path.c_str(), 1);
  std::vector<std::string> command = {python, "-m", "oitlab_analysis"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return runCommand(command, false);
}

}  // namespace oitlab
