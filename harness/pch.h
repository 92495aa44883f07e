// Precompiled: the headers that nearly every file needs and that are slow to parse.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <vulkan/vulkan_raii.hpp>
