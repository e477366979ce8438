# What others build on: libspindrift.a with its headers, found by find_package(spindrift).
# Installed by cmake --install build --prefix FOLDER --component library
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

add_library(spindrift_sim STATIC
  $<TARGET_OBJECTS:core> $<TARGET_OBJECTS:scene> $<TARGET_OBJECTS:sim> $<TARGET_OBJECTS:gpu>)
add_library(spindrift::sim ALIAS spindrift_sim)
set_target_properties(spindrift_sim PROPERTIES OUTPUT_NAME spindrift EXPORT_NAME sim)
target_compile_features(spindrift_sim PUBLIC cxx_std_20)
target_include_directories(spindrift_sim PUBLIC
  $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}/include> $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}/source>
  $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
  $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/spindrift>)
target_link_libraries(spindrift_sim PUBLIC
  PkgConfig::HDF5 PkgConfig::HWY fmt::fmt assimp::assimp OpenMP::OpenMP_CXX
  $<$<BOOL:${SPINDRIFT_HAS_CUDA}>:CUDA::cudart_static>)

set(package ${CMAKE_INSTALL_LIBDIR}/cmake/spindrift)
install(TARGETS spindrift_sim EXPORT spindriftTargets ARCHIVE COMPONENT library)
install(EXPORT spindriftTargets NAMESPACE spindrift:: DESTINATION ${package} COMPONENT library)
install(DIRECTORY include/spindrift DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT library)
# spindrift.h and what it includes: CI compiles a program against the installed copy.
foreach(header
    core/color_map.h core/error.h core/pass_time.h core/vec.h core/vertex.h
    scene/check.h scene/json.h scene/particles.h scene/sample_object.h scene/sample_solid.h scene/scene.h
    sim/energy_ledger.h sim/object_driver.h sim/object_state.h sim/run_state.h sim/simulation.h
    sim/solid_motion.h sim/step_state.h)
  cmake_path(GET header PARENT_PATH folder)
  install(FILES source/${header} COMPONENT library
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/spindrift/${folder})
endforeach()
configure_package_config_file(cmake/spindriftConfig.cmake.in spindriftConfig.cmake
  INSTALL_DESTINATION ${package})
write_basic_package_version_file(spindriftConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES
  ${CMAKE_BINARY_DIR}/spindriftConfig.cmake ${CMAKE_BINARY_DIR}/spindriftConfigVersion.cmake
  DESTINATION ${package} COMPONENT library)
