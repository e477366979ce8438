# CUDA is compiled when nvcc is there and never required: the program starts without a driver (the runtime is linked
# statically) and says then that there is no GPU.
include(CheckLanguage)
if(NOT CMAKE_CUDA_COMPILER AND NOT DEFINED ENV{CUDACXX} AND EXISTS /usr/local/cuda/bin/nvcc)
  set(CMAKE_CUDA_COMPILER /usr/local/cuda/bin/nvcc)
endif()
set(CMAKE_CUDA_ARCHITECTURES ${SPINDRIFT_CUDA_ARCHITECTURES})
check_language(CUDA)
if(NOT CMAKE_CUDA_COMPILER)
  message(STATUS "no nvcc: built without GPU")
  return()
endif()
enable_language(CUDA)
find_package(CUDAToolkit REQUIRED)
# CMake 3.25 does not know C++20 for nvcc 13.
set(CMAKE_CUDA20_STANDARD_COMPILE_OPTION -std=c++20)
set(CMAKE_CUDA20_EXTENSION_COMPILE_OPTION -std=c++20)
set(CMAKE_CUDA_STANDARD 20)
set(CMAKE_CUDA_RUNTIME_LIBRARY Static)
if(CCACHE)
  set(CMAKE_CUDA_COMPILER_LAUNCHER ${CCACHE})
endif()
set(SPINDRIFT_HAS_CUDA ON)

function(spindrift_use_cuda target)
  target_link_libraries(${target} PUBLIC CUDA::cudart_static)
  # Roots and quotients to 2 units in the last place: the exact ones take several times as long.
  target_compile_options(${target} PRIVATE $<$<COMPILE_LANGUAGE:CUDA>:--prec-sqrt=false --prec-div=false --ftz=true>)
endfunction()
