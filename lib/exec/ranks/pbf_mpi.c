/* MPI for pbf, compiled on the machine on which it runs:
     mpicc -O2 -shared -fPIC -o libpbf_mpi.so pbf_mpi.c
   The program opens it when it is started on several ranks. */
#define _POSIX_C_SOURCE 199309L /* nanosleep() */

#include "pbf_mpi.h"

#include <mpi.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { most_piece = 1 << 30, tag = 7 }; /* counts of MPI are int */

#define TRY(call)                             \
  do {                                        \
    const int error_ = (call);                \
    if (error_ != MPI_SUCCESS) return error_; \
  } while (0)

static MPI_Request* requests = NULL;
static int used = 0, room = 0;

static int next_request(MPI_Request** request) {
  if (used == room) {
    MPI_Request* more = realloc(requests, sizeof *more * (size_t)(2 * room + 16));
    if (!more) return MPI_ERR_NO_MEM;
    requests = more;
    room = 2 * room + 16;
  }
  *request = &requests[used++];
  return MPI_SUCCESS;
}

/* Begins the pieces of a message; an empty message is one piece. */
static int begin(const struct pbf_mpi_message* m, int send) {
  size_t done = 0;
  do {
    const size_t left = m->bytes - done, piece = left < most_piece ? left : most_piece;
    MPI_Request* r = NULL;
    TRY(next_request(&r));
    char* at = (char*)m->data + done;
    TRY(send ? MPI_Isend(at, (int)piece, MPI_BYTE, m->rank, tag, MPI_COMM_WORLD, r)
             : MPI_Irecv(at, (int)piece, MPI_BYTE, m->rank, tag, MPI_COMM_WORLD, r));
    done += piece;
  } while (done < m->bytes);
  return MPI_SUCCESS;
}
static int wait_for_all(void) {
  const int n = used;
  used = 0;
  return n ? MPI_Waitall(n, requests, MPI_STATUSES_IGNORE) : MPI_SUCCESS;
}

static int start(int* rank, int* size) {
  int given = 0;
  TRY(MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &given));
  TRY(MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN));
  TRY(MPI_Comm_rank(MPI_COMM_WORLD, rank));
  return MPI_Comm_size(MPI_COMM_WORLD, size);
}
static int describe(char* text, int bytes) {
  char all[MPI_MAX_LIBRARY_VERSION_STRING];
  int length = 0;
  TRY(MPI_Get_library_version(all, &length));
  all[strcspn(all, ",\n")] = 0; /* the name and the version */
  strncpy(text, all, (size_t)bytes - 1);
  text[bytes - 1] = 0;
  return MPI_SUCCESS;
}
static int exchange(const struct pbf_mpi_message* out, int outs, const struct pbf_mpi_message* in,
                    int ins) {
  for (int k = 0; k < ins; ++k) TRY(begin(&in[k], 0));
  for (int k = 0; k < outs; ++k) TRY(begin(&out[k], 1));
  return wait_for_all();
}
/* A message of which only the sender knows the size must be one piece. */
static int send(const struct pbf_mpi_message* out, int outs) {
  for (int k = 0; k < outs; ++k) {
    if (out[k].bytes > most_piece) return MPI_ERR_COUNT;
    TRY(begin(&out[k], 1));
  }
  return MPI_SUCCESS;
}
static int await(int from, size_t* bytes) {
  MPI_Status status;
  int n = 0;
  TRY(MPI_Probe(from, tag, MPI_COMM_WORLD, &status));
  TRY(MPI_Get_count(&status, MPI_BYTE, &n));
  *bytes = (size_t)n;
  return MPI_SUCCESS;
}
static int receive(const struct pbf_mpi_message* in) {
  return MPI_Recv(in->data, (int)in->bytes, MPI_BYTE, in->rank, tag, MPI_COMM_WORLD,
                  MPI_STATUS_IGNORE);
}
static int all_gather(const void* mine, size_t bytes, void* all) {
  return MPI_Allgather(mine, (int)bytes, MPI_BYTE, all, (int)bytes, MPI_BYTE, MPI_COMM_WORLD);
}
static int sum(int64_t* values, size_t n) {
  for (size_t done = 0; done < n;) {
    const size_t left = n - done, piece = left < most_piece / 8 ? left : most_piece / 8;
    TRY(MPI_Allreduce(MPI_IN_PLACE, values + done, (int)piece, MPI_INT64_T, MPI_SUM,
                      MPI_COMM_WORLD));
    done += piece;
  }
  return MPI_SUCCESS;
}
static int broadcast(void* data, size_t bytes, int patient) {
  size_t done = 0;
  do {
    const size_t left = bytes - done, piece = left < most_piece ? left : most_piece;
    MPI_Request r;
    TRY(MPI_Ibcast((char*)data + done, (int)piece, MPI_BYTE, 0, MPI_COMM_WORLD, &r));
    int there = 0;
    for (long asked = 0; !there; ++asked) {
      TRY(MPI_Test(&r, &there, MPI_STATUS_IGNORE));
      if (there || !patient || asked < 1000) continue;
      const struct timespec nap = {0, 100000}; /* 0.1 ms */
      nanosleep(&nap, NULL);
    }
    done += piece;
  } while (done < bytes);
  return MPI_SUCCESS;
}
static void abort_all(int code) { MPI_Abort(MPI_COMM_WORLD, code); }
static int finish(void) { return MPI_Finalize(); }

const struct pbf_mpi* pbf_mpi_table(void) {
  static const struct pbf_mpi table = {PBF_MPI_TABLE, start,     describe,     exchange,   send,
                                       await,         receive,   wait_for_all, all_gather, sum,
                                       broadcast,     abort_all, finish};
  return &table;
}
