#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cli/commands.h"
#include "util/error.h"
#include "util/paths.h"

namespace oitlab {
namespace {

/// Runs a program with its output as ours (or thrown away); its exit code, or 127.
int runProgram(const std::vector<std::string>& arguments, bool quiet) {
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

/// A Python that has what the analysis needs. The first `python3` of the path may be one of the
/// user's own without matplotlib, although the system's has it.
std::string findPython() {
  std::vector<std::string> candidates;
  if (const char* given = std::getenv("OITLAB_PYTHON"); given && *given)
    candidates = {given};
  else
    candidates = {"python3", "/usr/bin/python3", "python"};
  for (const std::string& python : candidates)
    if (runProgram({python, "-c", "import matplotlib, pandas, jinja2"}, true) == 0) {
      if (python != candidates.front())
        fmt::print(stderr, "using {}: {} lacks matplotlib, pandas or jinja2\n", python,
                   candidates.front());
      return python;
    }
  fail<InputError>(
      "no Python with matplotlib, pandas and jinja2 (tried {}); install python3-matplotlib, "
      "python3-pandas and python3-jinja2, or set OITLAB_PYTHON",
      fmt::join(candidates, ", "));
}

int report(const std::string& folder) {
  if (!std::filesystem::is_directory(folder))
    fail<InputError>(
        "{}: no such results folder; `oitlab run experiments/quickstart.toml` makes one", folder);
  const std::string python = findPython();
  std::string path = (dataRoot() / "analysis").string();
  if (const char* before = std::getenv("PYTHONPATH"); before && *before)
    path += std::string(":") + before;
  setenv("PYTHONPATH", path.c_str(), 1);
  return runProgram({python, "-m", "oitlab_analysis", "report", folder}, false);
}

}  // namespace

void addReport(CLI::App& program, Action& action) {
  auto folder = std::make_shared<std::string>();
  CLI::App* verb =
      program.add_subcommand("report", "Table, plots, HTML and Markdown of a results folder");
  verb->add_option("results", *folder, "The folder that `oitlab run` wrote")->required();
  verb->callback([=, &action] { action = [=] { return report(*folder); }; });
}

}  // namespace oitlab
