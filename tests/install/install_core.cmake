# SPDX-License-Identifier: Apache-2.0

# Installs pellucid without its renderer and looks at what came.
# -D SOURCE= BUILD= PREFIX= GENERATOR= COMPILER=
file(REMOVE_RECURSE "${PREFIX}")
execute_process(COMMAND_ERROR_IS_FATAL ANY
  COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${BUILD} -G ${GENERATOR}
    -DCMAKE_CXX_COMPILER=${COMPILER} -DPELLUCID_BUILD_RENDERER=OFF -DPELLUCID_BUILD_TESTS=OFF)
execute_process(COMMAND_ERROR_IS_FATAL ANY COMMAND ${CMAKE_COMMAND} --build ${BUILD})
execute_process(COMMAND_ERROR_IS_FATAL ANY
  COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${PREFIX})

file(GLOB_RECURSE files RELATIVE "${PREFIX}" "${PREFIX}/*")
foreach(file IN LISTS files)
  if(file MATCHES "\\.a$|/bin/|include/pellucid/(scene|cpu|reference|io)/")
    message(SEND_ERROR "${file} is no part of the core")
  endif()
endforeach()
if(NOT EXISTS "${PREFIX}/include/pellucid/render/integrate_ray.h")
  message(SEND_ERROR "include/pellucid/render/integrate_ray.h was not installed")
endif()
