#pragma once

#include <CLI/CLI.hpp>

namespace oitlab {

/// Adds --allow-outside, which all verbs that load scenes have.
inline void addAllowOutside(CLI::App& verb, bool& allowOutside) {
  verb.add_flag("--allow-outside", allowOutside, "Let scene files name files outside their folder");
}

}  // namespace oitlab
