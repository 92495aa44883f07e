#pragma once

#include "experiment/experiment.h"
#include "experiment/toml_reader.h"

namespace oitlab {

/// The names of the tables [profile.NAME] of an experiment. Throws InputError where `profile` is
/// something else.
std::vector<std::string> profileNames(const std::string& file, const toml::table& root);

/// Puts what [profile.NAME] says in place of what the file says at its top; tables such as
/// [measure] key by key. `brief` needs no table: it lowers [measure] first, and [profile.brief] can
/// change that. Returns the name of the profile that was used. Throws InputError.
std::string applyProfile(const std::string& file, toml::table& root,
                         const ExperimentOptions& options);

}  // namespace oitlab
