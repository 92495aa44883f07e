# What only one file knows, so that it does not stand in every command line: a new commit compiles one
# file, and ccache serves one clone with what another compiled.
# The commit that the program was built from, refreshed on every build: a result must say it.
set(provenance_dir ${CMAKE_BINARY_DIR}/generated/provenance)
add_custom_target(oitlab_commit
  COMMAND ${CMAKE_COMMAND} -DSOURCE_DIR=${CMAKE_SOURCE_DIR} -DOUTPUT=${provenance_dir}/commit.h
          -P ${CMAKE_SOURCE_DIR}/cmake/write_commit.cmake
  BYPRODUCTS ${provenance_dir}/commit.h
  COMMENT "")
# For the targets of the current folder, which is as far as CMake takes properties of sources.
macro(oitlab_set_provenance)
  set_source_files_properties(${CMAKE_SOURCE_DIR}/harness/util/version.cpp PROPERTIES
    INCLUDE_DIRECTORIES ${provenance_dir}
    COMPILE_DEFINITIONS "OITLAB_VERSION=\"${PROJECT_VERSION}\";OITLAB_BUILD_TYPE=\"$<CONFIG>\"")
  set_source_files_properties(${CMAKE_SOURCE_DIR}/harness/util/paths.cpp PROPERTIES
    COMPILE_DEFINITIONS OITLAB_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
endmacro()
oitlab_set_provenance()
