# SPDX-License-Identifier: Apache-2.0
# Language, warnings and sanitizers, the same for every target (talus_options).
set(CMAKE_C_STANDARD 17)
set(CMAKE_C_STANDARD_REQUIRED ON)
set(CMAKE_C_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
option(TALUS_SANITIZE "Address and undefined behaviour sanitizers" OFF)
option(TALUS_THREAD_SANITIZE "Thread sanitizer" OFF)

execute_process(COMMAND git -C ${CMAKE_SOURCE_DIR} rev-parse --short HEAD
    OUTPUT_VARIABLE TALUS_REVISION OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)

add_library(talus_options INTERFACE)
target_compile_definitions(talus_options INTERFACE _GNU_SOURCE)
target_compile_options(talus_options INTERFACE -Wall -Wextra -Wshadow -Wconversion -Werror)
target_include_directories(talus_options INTERFACE ${CMAKE_SOURCE_DIR}/include)
if(TALUS_SANITIZE)
    target_compile_options(talus_options INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(talus_options INTERFACE -fsanitize=address,undefined)
endif()
if(TALUS_THREAD_SANITIZE)
    target_compile_options(talus_options INTERFACE -fsanitize=thread)
    target_link_options(talus_options INTERFACE -fsanitize=thread)
endif()
