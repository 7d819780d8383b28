/* MPI for pbf, compiled on the machine on which it runs:
     mpicc -O2 -shared -fPIC -o libpbf_mpi.so pbf_mpi.c
   The program opens it when it is started on several ranks. */
#define _POSIX_C_SOURCE 200112L /* nanosleep(), gethostname() */

#include "pbf_mpi.h"

#include <mpi.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { most_piece = 1 << 30 }; /* counts of MPI are int */
enum { tag = 7, tag_ask, tag_answer };
enum { host_bytes = 64 };

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

/* A rank that waits for too long asks all others whether they live. Those that wait answer. */
static double deadline = 0; /* s; 0: none */
static int me = 0, ranks = 1, question = 0;
static char* hosts = NULL; /* host_bytes for each rank */
static char* heard = NULL; /* whether each rank has answered */
static char why[512] = "";

static double seconds(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}
static int answer_others(void) {
  for (;;) {
    int there = 0, number = 0;
    MPI_Status s;
    TRY(MPI_Iprobe(MPI_ANY_SOURCE, tag_ask, MPI_COMM_WORLD, &there, &s));
    if (!there) return MPI_SUCCESS;
    TRY(MPI_Recv(&number, 1, MPI_INT, s.MPI_SOURCE, tag_ask, MPI_COMM_WORLD, &s));
    TRY(MPI_Send(&number, 1, MPI_INT, s.MPI_SOURCE, tag_answer, MPI_COMM_WORLD));
  }
}
static int hear_answers(void) {
  for (;;) {
    int there = 0, number = 0;
    MPI_Status s;
    TRY(MPI_Iprobe(MPI_ANY_SOURCE, tag_answer, MPI_COMM_WORLD, &there, &s));
    if (!there) return MPI_SUCCESS;
    TRY(MPI_Recv(&number, 1, MPI_INT, s.MPI_SOURCE, tag_answer, MPI_COMM_WORLD, &s));
    if (number == question) heard[s.MPI_SOURCE] = 1;
  }
}
static int ask_others(void) {
  ++question;
  memset(heard, 0, (size_t)ranks);
  heard[me] = 1;
  static int numbers[1024]; /* stay as they are while they are sent */
  int* number = &numbers[question % 1024];
  *number = question;
  for (int r = 0; r < ranks; ++r) {
    if (r == me) continue;
    MPI_Request sent; /* a rank that hangs takes nothing: do not wait for it */
    TRY(MPI_Isend(number, 1, MPI_INT, r, tag_ask, MPI_COMM_WORLD, &sent));
    TRY(MPI_Request_free(&sent));
  }
  return MPI_SUCCESS;
}
/* What a rank waits for: sets *there when it is there. */
typedef int awaited(void* of, int* there);
static int all_done(void* of, int* there) {
  (void)of;
  return MPI_Testall(used, requests, there, MPI_STATUSES_IGNORE);
}
/* After the deadline: waits for answers for a while, also for what is awaited. */
static int find_silent(awaited* test, void* of, int* there) {
  const double begun = seconds(), most = deadline < 10 ? deadline : 10;
  const struct timespec nap = {0, 100000}; /* 0.1 ms */
  int silent = 0, reporter = 0;
  TRY(ask_others());
  while (seconds() - begun < most) {
    TRY(test(of, there));
    if (*there) return MPI_SUCCESS;
    TRY(answer_others());
    TRY(hear_answers());
    nanosleep(&nap, NULL);
  }
  while (silent < ranks && heard[silent]) ++silent;
  if (silent == ranks) return MPI_SUCCESS; /* all live; wait on */
  snprintf(why, sizeof why,
           "rank %d on %s has not answered for %.0f s: it hangs, or its machine is gone (the "
           "environment variable PBF_RANK_DEADLINE sets the seconds, 0 for no end)",
           silent, hosts + (size_t)silent * host_bytes, deadline + most);
  while (!heard[reporter]) ++reporter;
  while (reporter != me && seconds() - begun < most + 5) { /* one tells it */
    TRY(answer_others());
    nanosleep(&nap, NULL);
  }
  return PBF_MPI_SILENT;
}
/* patient: leaves the core to others, and waits ten times as long: rank 0 may be writing files. */
static int wait_for(awaited* test, void* of, int patient) {
  const struct timespec nap = {0, 100000}; /* 0.1 ms */
  double begun = 0;
  for (long tries = 0;; ++tries) {
    int there = 0;
    TRY(test(of, &there));
    if (there) return MPI_SUCCESS;
    if (tries < 1000) continue;
    if (tries == 1000) begun = seconds();
    patient ? (void)nanosleep(&nap, NULL) : (void)sched_yield();
    if (tries % 64 != 0) continue;
    TRY(answer_others());
    if (deadline <= 0 || seconds() - begun < deadline * (patient ? 10 : 1)) continue;
    TRY(find_silent(test, of, &there));
    if (there) return MPI_SUCCESS;
    begun = seconds();
  }
}
static int wait_for_all(int patient) { /* requests */
  TRY(wait_for(all_done, NULL, patient));
  used = 0;
  return MPI_SUCCESS;
}
struct question_to {
  int (*done)(void* of);
  void* of;
};
static int is_done(void* of, int* there) {
  const struct question_to* q = of;
  *there = q->done(q->of);
  return MPI_SUCCESS;
}
static int wait_until(int (*done)(void* of), void* of) {
  struct question_to q = {done, of};
  return wait_for(is_done, &q, 0);
}
static int start(double most_wait, int* rank, int* size) {
  int given = 0;
  TRY(MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &given));
  TRY(MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN));
  TRY(MPI_Comm_rank(MPI_COMM_WORLD, &me));
  TRY(MPI_Comm_size(MPI_COMM_WORLD, &ranks));
  *rank = me;
  *size = ranks;
  deadline = most_wait;
  hosts = calloc((size_t)ranks, host_bytes);
  heard = calloc((size_t)ranks, 1);
  if (!hosts || !heard) return MPI_ERR_NO_MEM;
  char* mine = hosts + (size_t)me * host_bytes;
  gethostname(mine, host_bytes - 1);
  return MPI_Allgather(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, hosts, host_bytes, MPI_CHAR,
                       MPI_COMM_WORLD);
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
  return wait_for_all(0);
}
static int all_gather(const void* mine, size_t bytes, void* all) {
  MPI_Request* r = NULL;
  TRY(next_request(&r));
  TRY(MPI_Iallgather(mine, (int)bytes, MPI_BYTE, all, (int)bytes, MPI_BYTE, MPI_COMM_WORLD, r));
  return wait_for_all(0);
}
static int sum(int64_t* values, size_t n) {
  for (size_t done = 0; done < n;) {
    const size_t left = n - done, piece = left < most_piece / 8 ? left : most_piece / 8;
    MPI_Request* r = NULL;
    TRY(next_request(&r));
    TRY(MPI_Iallreduce(MPI_IN_PLACE, values + done, (int)piece, MPI_INT64_T, MPI_SUM,
                       MPI_COMM_WORLD, r));
    TRY(wait_for_all(0));
    done += piece;
  }
  return MPI_SUCCESS;
}
static int broadcast(void* data, size_t bytes, int patient) {
  size_t done = 0;
  do {
    const size_t left = bytes - done, piece = left < most_piece ? left : most_piece;
    MPI_Request* r = NULL;
    TRY(next_request(&r));
    TRY(MPI_Ibcast((char*)data + done, (int)piece, MPI_BYTE, 0, MPI_COMM_WORLD, r));
    TRY(wait_for_all(patient));
    done += piece;
  } while (done < bytes);
  return MPI_SUCCESS;
}
static const char* trouble(void) { return why; }
static void abort_all(int code) { MPI_Abort(MPI_COMM_WORLD, code); }
static int finish(void) { return MPI_Finalize(); }

const struct pbf_mpi* pbf_mpi_table(void) {
  static const struct pbf_mpi table = {PBF_MPI_TABLE, start, describe,  exchange,
                                       all_gather,    sum,   broadcast, wait_until,
                                       trouble,       abort_all, finish};
  return &table;
}
