#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

namespace oitlab {

/// The version of what a cell holds. A program replaces damaged cells and those of older versions,
/// and leaves those of newer ones alone.
constexpr int cellSchema = 1;

/// What keeps `cell` from being the whole cell `id` of the folder `results`; "" when nothing does.
/// A whole cell is an object of the schema with its own id, a known status and a group. With status
/// "ok" it has times, samples with their blocks, an image that is there, and, where it has a
/// reference, its quality; with another, a reason.
std::string findDamage(const nlohmann::json& cell, const std::string& id,
                       const std::filesystem::path& results);

}  // namespace oitlab
