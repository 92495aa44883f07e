#include "results/owner.h"

#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include <fmt/format.h>

namespace oitlab {
namespace {

std::string firstLine(const std::string& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  return line;
}

/// Containers on one machine have pids of their own.
std::string thisMachine() {
  std::error_code ignored;
  const auto processes = std::filesystem::read_symlink("/proc/self/ns/pid", ignored);
  return firstLine("/proc/sys/kernel/random/boot_id") + " " + processes.string();
}

/// Field 22 of /proc/PID/stat (proc(5)): the start of the process in clock ticks since boot. Empty
/// where there is no such process.
std::string startOf(int process) {
  const std::string line = firstLine(fmt::format("/proc/{}/stat", process));
  const std::size_t name = line.rfind(')');  // field 2, which may hold blanks
  if (name == line.npos) return "";
  std::istringstream fields(line.substr(name + 1));
  std::string field;
  for (int number = 3; number <= 22; ++number) fields >> field;
  return field;
}

std::string newToken() {
  std::random_device random;
  return fmt::format("{:08x}{:08x}", random(), random());
}

}  // namespace

Owner Owner::self() {
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  return {newToken(), host, thisMachine(), getpid(), startOf(getpid())};
}

nlohmann::json Owner::toJson() const {
  return {{"token", token},
          {"host", host},
          {"machine", machine},
          {"process", process},
          {"started", started}};
}

Owner Owner::fromJson(const nlohmann::json& json) {
  Owner owner;
  const auto text = [&](const char* key) {
    const auto found = json.find(key);
    return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
  };
  if (!json.is_object()) return owner;
  owner.token = text("token");
  owner.host = text("host");
  owner.machine = text("machine");
  owner.started = text("started");
  const auto process = json.find("process");
  if (process != json.end() && process->is_number_integer()) owner.process = process->get<int>();
  return owner;
}

std::string Owner::describe() const {
  return process > 0 ? fmt::format("process {} on {}", process, host) : "another process";
}

bool Owner::isDead() const {
  if (process <= 0 || machine != thisMachine()) return false;
  if (kill(process, 0) != 0 && errno == ESRCH) return true;
  const std::string start = startOf(process);
  return !start.empty() && !started.empty() && start != started;
}

}  // namespace oitlab
