#include "cli/commands.h"
#include "util/error.h"
#include "util/python.h"

namespace oitlab {
namespace {

int report(const std::string& folder) {
  if (!std::filesystem::is_directory(folder))
    fail<InputError>(
        "{}: no such results folder; `oitlab run experiments/quickstart.toml` makes one", folder);
  const auto python = findPython({"matplotlib", "pandas", "jinja2"});
  if (!python)
    fail<InputError>(
        "no Python with matplotlib, pandas and jinja2 (tried {}); install python3-matplotlib, "
        "python3-pandas and python3-jinja2, or set OITLAB_PYTHON",
        fmt::join(pythonCandidates(), ", "));
  return runAnalysis(*python, {"report", folder});
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
