# SPDX-License-Identifier: Apache-2.0
# The toolchain of the preset aarch64: Debian's cross compiler (scripts/build_aarch64.sh installs it with the libraries).
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
