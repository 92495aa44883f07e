#include "cli/commands.h"
#include "results/describe.h"
#include "util/error.h"
#include "util/suggest.h"
#include "util/version.h"

namespace oitlab {
namespace {

/// CLI11 says what it did not expect. This adds a suggestion of what was meant.
std::string explain(const CLI::App& program, const CLI::ParseError& error) {
  std::string message = error.what();
  const CLI::App* verb = &program;
  for (const CLI::App* chosen : program.get_subcommands()) verb = chosen;
  std::vector<std::string> names;
  for (const CLI::App* child : verb->get_subcommands({})) names.push_back(child->get_name());
  for (const CLI::Option* option : verb->get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  // After a misspelt option its value is unexpected too; the first word is the mistake.
  if (const auto extras = verb->remaining(true); !extras.empty())
    message =
        fmt::format("'{}' is not known here{}", extras.front(), didYouMean(extras.front(), names));
  return message;
}

int runProgram(int argc, char** argv) {
  setCommandLine(argc, argv);
  CLI::App program(
      "oitlab compares order-independent-transparency methods: the same scenes, shading and clock.",
      "oitlab");
  program.require_subcommand(1);
  program.set_version_flag("--version", versionLine(), "Version, commit, build type");
  program.set_help_all_flag("--help-all", "Help for every verb");
  program.footer(
      "Examples:\n"
      "  oitlab list methods\n"
      "  oitlab render --scene boxes --method reference --out boxes.png\n"
      "  oitlab run experiments/quickstart.toml && oitlab report results/quickstart\n"
      "Exit codes: 0 done, 1 some cells failed, 2 bad input, 3 no usable Vulkan device,\n"
      "4 results cannot be written, 5 a mistake of oitlab's own, 130 and 143 stopped by a signal.");
  Action action;
  addInfo(program, action);
  addList(program, action);
  addScene(program, action);
  addRender(program, action);
  addRun(program, action);
  addCompare(program, action);
  addDepth(program, action);
  addAnalysis(program, action);
  try {
    program.parse(argc, argv);
    return action();
  } catch (const CLI::Success& help) {
    return program.exit(help);  // --help, --version
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "oitlab: {}; see `oitlab{}{} --help`\n", explain(program, error),
               program.get_subcommands().empty() ? "" : " ",
               program.get_subcommands().empty() ? "" : program.get_subcommands()[0]->get_name());
    return exitBadInput;
  } catch (const InputError& error) {
    fmt::print(stderr, "oitlab: {}\n", error.what());
    return exitBadInput;
  } catch (const DeviceError& error) {
    fmt::print(stderr, "oitlab: {}\n", error.what());
    return exitNoDevice;
  } catch (const OutputError& error) {
    fmt::print(stderr,
               "oitlab: {}; what was there is as it was, and the same command goes on from there\n",
               error.what());
    return exitCannotWrite;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "oitlab: not enough main memory\n");
    return exitBadInput;
  } catch (const vk::SystemError& error) {
    fmt::print(stderr, "oitlab: the Vulkan driver failed: {}\n", error.what());
    return exitNoDevice;
  } catch (const std::exception& error) {
    fmt::print(stderr, "oitlab: a mistake of oitlab's own: {}; please report it\n", error.what());
    return exitInternal;
  }
}

}  // namespace
}  // namespace oitlab

int main(int argc, char** argv) {
  return oitlab::runProgram(argc, argv);
}
