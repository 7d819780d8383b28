# The module through which the program opens MPI when it is started on several ranks; made where there
# is a compiler of MPI. The program itself is not linked with MPI.
find_program(PBF_MPICC mpicc DOC "Compiler of MPI, for runs on several ranks")
if(PBF_MPICC)
  set(module ${PROJECT_SOURCE_DIR}/lib/exec/ranks/pbf_mpi)
  add_custom_command(OUTPUT ${PROJECT_BINARY_DIR}/libpbf_mpi.so
    COMMAND ${PBF_MPICC} -O2 -Wall -Wextra -std=c11 -shared -fPIC
            -o ${PROJECT_BINARY_DIR}/libpbf_mpi.so ${module}.c
    DEPENDS ${module}.c ${module}.h COMMENT "Building the module for MPI")
  add_custom_target(pbf_mpi ALL DEPENDS ${PROJECT_BINARY_DIR}/libpbf_mpi.so)
endif()
