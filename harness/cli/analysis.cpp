#include "cli/commands.h"
#include "util/error.h"
#include "util/python.h"

namespace oitlab {
namespace {

/// Verbs that the Python package implements, with their options, --help and errors. Its exit codes
/// are those of the program.
struct AnalysisVerb {
  const char* name;
  const char* summary;
};

constexpr AnalysisVerb analysisVerbs[] = {
    {"report", "Table, plots, HTML and Markdown of results folders and packs"},
    {"diff", "What became faster, slower or different from one results folder to another"},
    {"paper", "The papers' tables and figures, published beside measured"},
    {"pack", "The raw cells of a results folder as one small file"},
};

int analyse(const std::string& name, const std::vector<std::string>& arguments) {
  const auto python = findPython({"matplotlib", "pandas", "jinja2"});
  if (!python)
    fail<InputError>(
        "no Python with matplotlib, pandas and jinja2 (tried {}); install python3-matplotlib, "
        "python3-pandas and python3-jinja2, or set OITLAB_PYTHON",
        fmt::join(pythonCandidates(), ", "));
  std::vector<std::string> command = {name};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return runAnalysis(*python, command);
}

}  // namespace

void addAnalysis(CLI::App& program, Action& action) {
  for (const auto& [name, summary] : analysisVerbs) {
    CLI::App* verb = program.add_subcommand(name, summary);
    verb->set_help_flag();
    verb->prefix_command();  // the remaining arguments are passed on unchanged
    verb->callback([=, &action, name = std::string(name)] {
      action = [=] { return analyse(name, verb->remaining()); };
    });
  }
}

}  // namespace oitlab
