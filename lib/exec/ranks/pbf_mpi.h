/* The functions of MPI that the program uses, as a table. The module pbf_mpi.c, compiled for the
   MPI of a machine, returns it; the program opens the module at run time and is not linked with
   MPI. Functions return 0, an error code of MPI, or PBF_MPI_SILENT if another rank hangs. */
#ifndef PBF_MPI_H
#define PBF_MPI_H

#include <stddef.h>
#include <stdint.h>

enum { PBF_MPI_TABLE = 4 }; /* changes with the table */
enum { PBF_MPI_SILENT = -1 };

struct pbf_mpi_message {
  int rank; /* to or from which it goes */
  void* data;
  size_t bytes;
};

struct pbf_mpi {
  int table;
  /* deadline: seconds after which a rank that waits asks the others whether they live; 0: never. */
  int (*start)(double deadline, int* rank, int* size);
  int (*describe)(char* text, int bytes); /* "Open MPI v4.1.4" */
  /* All at once. Receives exactly the bytes that `in` says. */
  int (*exchange)(const struct pbf_mpi_message* out, int outs, const struct pbf_mpi_message* in,
                  int ins);
  int (*all_gather)(const void* mine, size_t bytes, void* all);
  int (*sum)(int64_t* values, size_t n);
  /* patient: leaves the core to others while it waits. */
  int (*broadcast)(void* data, size_t bytes, int patient);
  /* Returns when done(of) is not 0. */
  int (*wait_until)(int (*done)(void* of), void* of);
  const char* (*trouble)(void); /* after PBF_MPI_SILENT: which rank */
  void (*abort)(int code);
  int (*finish)(void);
};

#ifdef __cplusplus
extern "C"
#endif
    const struct pbf_mpi*
    pbf_mpi_table(void);

#endif
