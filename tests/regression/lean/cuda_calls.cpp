// Counts the calls of the CUDA runtime that a program makes, by name:
//   CUDA_INJECTION64_PATH=libcuda_calls.so CUDA_CALLS=FILE PROGRAM ...
#include <cupti.h>

#include <atomic>
#include <cstdlib>
#include <fstream>
#include <string>

namespace {

constexpr unsigned kMost = 4096;
std::atomic<long> calls[kMost];

void count(void*, CUpti_CallbackDomain, CUpti_CallbackId id, const void* data) {
  const auto* call = static_cast<const CUpti_CallbackData*>(data);
  if (call->callbackSite == CUPTI_API_ENTER && id < kMost) ++calls[id];
}

void report() {
  const char* path = std::getenv("CUDA_CALLS");
  std::ofstream out(path ? path : "cuda_calls.csv");
  out << "call,number\n";
  for (unsigned id = 0; id < kMost; ++id) {
    const char* name = nullptr;
    if (calls[id] == 0 ||
        cuptiGetCallbackName(CUPTI_CB_DOMAIN_RUNTIME_API, id, &name) != CUPTI_SUCCESS)
      continue;
    const std::string text(
        name);  // with the version in which the call came, as in cudaMalloc_v3020
    out << text.substr(0, text.rfind("_v")) << ',' << calls[id] << '\n';
  }
}

}  // namespace

/// The driver calls this function, by this name, before the program's first CUDA call.
extern "C" int InitializeInjection() {
  CUpti_SubscriberHandle subscriber;
  if (cuptiSubscribe(&subscriber, count, nullptr) != CUPTI_SUCCESS ||
      cuptiEnableDomain(1, subscriber, CUPTI_CB_DOMAIN_RUNTIME_API) != CUPTI_SUCCESS)
    return 0;
  return std::atexit(report) == 0;
}
