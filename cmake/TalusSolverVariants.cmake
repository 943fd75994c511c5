# SPDX-License-Identifier: Apache-2.0
# The solver is compiled once per instruction set, each with a worker program of its own: what is
# inlined into the kernels cannot be exchanged at run time, and a debugger or profiler sees every
# function once. talus_solver and talus-worker are the lowest instruction set; tests link them.
set(TALUS_ISA_BASE_NAME generic)
if(CMAKE_SYSTEM_PROCESSOR STREQUAL "aarch64")
    set(TALUS_ISA_BASE_NAME aarch64)
elseif(CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64")
    set(TALUS_ISA_BASE -march=x86-64-v2)
    set(TALUS_ISA_BASE_NAME x86-64-v2)
    set(TALUS_ISAS x86-64-v3 x86-64-v4)
    set(TALUS_ISA_x86-64-v3 -march=x86-64-v3)
    # Lanes are 256 bits wide; wider vectors would stay half empty.
    set(TALUS_ISA_x86-64-v4 -march=x86-64-v4 -mprefer-vector-width=256)
endif()
# What is built to be looked into is built once.
if(TALUS_SANITIZE OR TALUS_THREAD_SANITIZE OR TALUS_COVERAGE)
    set(TALUS_ISAS)
endif()

# For the loop of edit, build and test: one instruction set, one precision.
option(TALUS_QUICK "Build the solver for x86-64-v4 and double precision only" OFF)
if(TALUS_QUICK)
    set(TALUS_ISA_BASE ${TALUS_ISA_x86-64-v4})
    set(TALUS_ISAS)
endif()

# Compiles a solver library with further options.
function(talus_solver_options library)
    target_link_libraries(${library} PUBLIC talus_base PRIVATE OpenMP::OpenMP_C m)
    # -O3: the kernels are plain loops for the vectoriser. fp-contract: gcc turns it off under
    # -std=c17, which would leave not one fused multiply-add. No reordering is allowed (no
    # -ffast-math); errno and traps are not used by the solver. Vectors of lanes are passed between
    # static inline functions only: no ABI is involved. clang says so when it prefers not to
    # vectorise a loop; that is its choice.
    target_compile_options(${library} PRIVATE $<$<CONFIG:Release>:-O3> -ffp-contract=fast
        -fno-math-errno -fno-trapping-math -Wno-psabi $<$<C_COMPILER_ID:Clang>:-Wno-pass-failed>
        ${ARGN} INTERFACE -Wno-psabi)
endfunction()

# Where literals have to be of the type of the kernels, or each would drag a loop to double.
set(TALUS_KERNELS "/(math|shapes|materials|antilocking)/|/explicit/(kinematics|material_stage|anti_locking_[a-z_]*|out_of_plane)[.]c$")

# Adds talus_solver_VARIANT, compiled with further options: for double precision.
function(talus_add_solver variant)
    get_target_property(sources talus_solver SOURCES)
    add_library(talus_solver_${variant} STATIC ${sources})
    talus_solver_options(talus_solver_${variant} ${ARGN})
endfunction()

# A library, because options of libraries come last: -Wconversion must not come after its exception.
add_library(talus_single_literals INTERFACE)
target_compile_options(talus_single_literals INTERFACE
    $<$<C_COMPILER_ID:GNU>:-fsingle-precision-constant>
    $<$<C_COMPILER_ID:Clang>:-Wno-implicit-float-conversion>)

# The same for single precision. clang has no option for the type of literals: its build is right,
# but not fast.
function(talus_add_single_solver variant)
    get_target_property(sources talus_solver SOURCES)
    set(kernels ${sources})
    list(FILTER kernels INCLUDE REGEX "${TALUS_KERNELS}")
    list(FILTER sources EXCLUDE REGEX "${TALUS_KERNELS}")
    add_library(talus_kernels_${variant} OBJECT ${kernels})
    add_library(talus_solver_${variant} STATIC ${sources} $<TARGET_OBJECTS:talus_kernels_${variant}>)
    foreach(library talus_kernels_${variant} talus_solver_${variant})
        talus_solver_options(${library} ${ARGN})
        target_compile_definitions(${library} PUBLIC TALUS_SINGLE)
    endforeach()
    target_link_libraries(talus_kernels_${variant} PRIVATE talus_single_literals)
    set_target_properties(talus_kernels_${variant} PROPERTIES EXPORT_COMPILE_COMMANDS OFF)
endfunction()

# Adds the program talus-worker-VARIANT around talus_solver_VARIANT. Its solver comes first and
# whole, so that the plain one behind talus_scene and talus_output adds nothing.
function(talus_add_worker variant)
    add_executable(talus-worker-${variant} $<TARGET_OBJECTS:talus_worker_commands>)
    target_link_libraries(talus-worker-${variant} PRIVATE
        $<LINK_LIBRARY:WHOLE_ARCHIVE,talus_solver_${variant}> ${TALUS_WORKER_LIBRARIES})
    add_dependencies(talus-worker talus-worker-${variant})
    # Tools that read the code need to see it once.
    set_target_properties(talus_solver_${variant} talus-worker-${variant} PROPERTIES
        EXPORT_COMPILE_COMMANDS OFF)
endfunction()
