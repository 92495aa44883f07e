# The commit that the program was built from, refreshed on every build: a result must say it.
add_library(oitlab_provenance INTERFACE)
set(provenance_dir ${CMAKE_BINARY_DIR}/generated)
add_custom_target(oitlab_commit
  COMMAND ${CMAKE_COMMAND} -DSOURCE_DIR=${CMAKE_SOURCE_DIR} -DOUTPUT=${provenance_dir}/commit.h
          -P ${CMAKE_SOURCE_DIR}/cmake/write_commit.cmake
  BYPRODUCTS ${provenance_dir}/commit.h
  COMMENT "")
add_dependencies(oitlab_provenance oitlab_commit)
target_include_directories(oitlab_provenance INTERFACE ${provenance_dir})
target_compile_definitions(oitlab_provenance INTERFACE OITLAB_BUILD_TYPE="$<CONFIG>")
# Only for the file that uses it: the path of a clone in every command line would keep ccache from
# serving one clone with what another compiled.
set_source_files_properties(harness/util/paths.cpp PROPERTIES
  COMPILE_DEFINITIONS OITLAB_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
