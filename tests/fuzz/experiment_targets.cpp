// Experiments and the cells of a results folder.
#include <fstream>

#include "experiment/experiment.h"
#include "fuzz/targets.h"
#include "results/cell_check.h"
#include "util/json_file.h"

namespace oitlab {
namespace {

std::filesystem::path writeFile(const char* name, std::string_view bytes) {
  const auto path = fuzzFolder() / name;
  std::ofstream(path, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
  return path;
}

}  // namespace

void fuzzExperiment(std::string_view bytes) {
  const auto path = writeFile("experiment.toml", bytes);
  parseOrRefuse([&] { readExperiment(path); });
}

void fuzzCell(std::string_view bytes) {
  const auto path = writeFile("cell.json", bytes);
  parseOrRefuse([&] { findDamage(readJsonFile(path), "cell", fuzzFolder()); });
}

}  // namespace oitlab
