# The libraries of the field, all from the distribution (the launcher installs them).
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(VulkanHeaders CONFIG QUIET)
find_package(glslang CONFIG REQUIRED)
find_package(OpenEXR CONFIG REQUIRED)
find_package(TinyGLTF CONFIG REQUIRED)
find_package(tinyobjloader CONFIG REQUIRED)
find_package(nlohmann_json CONFIG REQUIRED)
find_package(tomlplusplus CONFIG REQUIRED)
find_package(CLI11 CONFIG REQUIRED)
find_package(fmt CONFIG REQUIRED)
find_package(glm CONFIG REQUIRED)
find_package(PNG REQUIRED)
pkg_check_modules(XXHASH REQUIRED IMPORTED_TARGET libxxhash)
pkg_check_modules(STB REQUIRED IMPORTED_TARGET stb)

add_library(oitlab_dependencies INTERFACE)
target_link_libraries(oitlab_dependencies INTERFACE
  Threads::Threads ${CMAKE_DL_LIBS}
  glslang::glslang glslang::SPIRV glslang::glslang-default-resource-limits
  OpenEXR::OpenEXR PNG::PNG fmt::fmt nlohmann_json::nlohmann_json
  tomlplusplus::tomlplusplus CLI11::CLI11 PkgConfig::XXHASH TinyGLTF::TinyGLTF tinyobjloader::tinyobjloader PkgConfig::STB)
target_compile_definitions(oitlab_dependencies INTERFACE
  GLM_FORCE_RADIANS GLM_FORCE_DEPTH_ZERO_TO_ONE GLM_ENABLE_EXPERIMENTAL)
