#include "experiment/cell.h"

#include <filesystem>

#include <fmt/format.h>

#include "image/hash.h"
#include "method/method.h"
#include "util/json_file.h"

namespace oitlab {
namespace {

namespace fs = std::filesystem;

/// Lower-case letters, digits, dots and dashes: safe on every file system.
std::string slug(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool keep = std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '_';
    if (keep)
      out += char(std::tolower(static_cast<unsigned char>(c)));
    else if (!out.empty() && out.back() != '-')
      out += '-';
  }
  while (!out.empty() && out.back() == '-') out.pop_back();
  return out.substr(0, 80);
}

std::string hashOn(const DeviceInfo& device, nlohmann::json identity) {
  identity["device"] = {device.name, device.driver, device.driverInfo};
  const std::string text = jsonText(identity, -1);  // a driver's name may not be UTF-8
  return imageHash(std::as_bytes(std::span(text)));
}

}  // namespace

std::string CellSpec::label() const {
  std::string text = fs::path(scene.source).stem().string();
  if (scene.opacity) text += fmt::format(" opacity {:g}", *scene.opacity);
  if (view != "default") text += " " + view;
  text += " " + method;
  if (method.empty()) return text;
  for (const Parameter& parameter : findMethod(method).parameters) {
    const ParameterValue& value = parameters.all().at(parameter.name);
    if (value != parameter.defaultValue)
      text += fmt::format(" {}={}", parameter.name, toString(value));
  }
  return text + fmt::format(" {}x{}", width, height);
}

nlohmann::json CellSpec::identity() const {
  nlohmann::json json = groupIdentity();
  json["method"] = method;
  json["parameters"] = parameters.toJson();
  return json;
}

nlohmann::json CellSpec::groupIdentity() const {
  nlohmann::json json;
  // A file is known by its name and content, not by its path: results may be resumed from another
  // folder.
  json["scene"] = {{"source", fs::path(scene.source).filename().string()},
                   {"detail", scene.detail}};
  if (!contentHash.empty()) json["scene"]["content_hash"] = contentHash;
  if (scene.opacity) json["scene"]["opacity"] = *scene.opacity;
  json["view"] = view;
  json["size"] = {width, height};
  json["format"] = formatName(format);
  return json;
}

std::string cellId(const CellSpec& cell, const DeviceInfo& device) {
  return slug(cell.label()) + "-" + hashOn(device, cell.identity()).substr(0, 10);
}

std::string groupKey(const CellSpec& cell, const DeviceInfo& device) {
  return hashOn(device, cell.groupIdentity()).substr(0, 16);
}

}  // namespace oitlab
