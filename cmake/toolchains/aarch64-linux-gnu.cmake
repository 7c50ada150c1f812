# SPDX-License-Identifier: Apache-2.0
#
# Builds for ARM64 with Debian's cross compiler and runs what was built with qemu.
# PELLUCID_ARM64_ROOT is a folder in which the packages of that architecture are unpacked:
# scripts/test-arm64 makes it.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(PELLUCID_ARM64_ROOT "" CACHE PATH "Packages of ARM64, unpacked")
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES PELLUCID_ARM64_ROOT)

set(CMAKE_SYSROOT "${PELLUCID_ARM64_ROOT}")
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64;-L;${PELLUCID_ARM64_ROOT})

# Programs are those of this machine, all else that of the other.
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
