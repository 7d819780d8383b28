// The commands behind the command line: options in, exit code out; errors are thrown as Error.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace pbf::inline app_module {

struct RunOptions {
  std::string scene;                   ///< path
  std::string out;                     ///< run folder; empty: out/<scene name>
  std::string backend, precision;      ///< empty: as the scene says
  int threads = 0;                     ///< 0: as the scene says
  std::vector<std::string> overrides;  ///< key.path=value
  bool overwrite = false, resume = false, quiet = false;
  bool strict = false;      ///< warnings are errors
  std::string log_json;     ///< path, empty: none
  double max_walltime = 0;  ///< s, 0: none
};

struct PlanOptions {
  std::string scene;
  std::vector<std::string> overrides;
  bool resolved = false, json = false;
};

struct RenderOptions {
  std::string run;             ///< path of run.vtkhdf
  std::string frames = "all";  ///< k, a:b, a:b:step (b excluded, negative from the end) or all
  std::string size;            ///< WxH, empty: as the scene says
  std::string camera;          ///< position=x,y,z;target=x,y,z;fov=deg;orbit=deg/s
  std::string color, range;    ///< empty: as the scene says
  std::string out;             ///< folder, empty: render/ beside the run file
};

struct ConfigOptions {
  bool schema = false, example = false;
};

struct BenchOptions {
  std::vector<std::string> scenes;  ///< paths; empty: the built-in dam break
  std::vector<std::int64_t> particles{10000, 100000};
  std::vector<std::string> backends{"cpu"}, precisions{"float"};
  std::vector<int> threads{0};  ///< 0: as a run would choose
  std::vector<std::string> overrides;
  int warmup = 400, updates = 64, repeats = 5;
  std::string csv, json;   ///< paths, empty: none
  bool calibrate = false;  ///< store the costs of the stages for `pbf plan`
};

struct StudyOptions {
  std::string study;                   ///< path of the study file
  std::string out;                     ///< folder; empty: out/study_<name>
  std::vector<std::string> overrides;  ///< key.path=value, for every run
  int repeats = 0;                     ///< 0: as the study says
  bool list = false, quiet = false;
};

struct BatchOptions {
  std::string input;                         ///< folder, scene or list
  std::string out;                           ///< folder of the runs; empty: out/batch_<name>
  std::vector<std::string> grid, overrides;  ///< key=v1,v2; key.path=value
  int jobs = 1, threads = 0;                 ///< at a time; CPU threads of each, 0: all / jobs
  std::int64_t only = -1;                    ///< this run alone, from 0
  double max_walltime = 0;                   ///< s, 0: none
  bool list = false, slurm = false, collect = false, quiet = false;
  bool strict = false;  ///< of every run
};

struct CompareOptions {
  std::vector<std::string> inputs;                  ///< two run files, or one scene with `between`
  std::vector<std::string> between;                 ///< two sides, BACKEND:PRECISION[@THREADS]
  std::vector<std::string> overrides, overrides_b;  ///< of both sides, of B alone
  int warmup = 50, updates = 100, members = 8;
  std::uint64_t seed = 1;
  std::string report;  ///< path, .html or .json; empty: none
  bool quiet = false;
};

struct StabilityCommandOptions {
  std::vector<std::string> cases;  ///< names or groups, empty: all; of a map: the scene's path
  std::string suite = "configs/stability.yaml";
  std::string backend = "cpu", precision = "float";
  bool reduced = false, quiet = false;
  int jobs = 0;  ///< cases at once; 0: as many as there are threads on cpu, 1 on cuda
  std::vector<std::string> overrides;
  std::string csv;        ///< path, empty: none
  std::string map, x, y;  ///< X_KEY,Y_KEY and their values; empty: no map
  std::vector<int> iterations{1, 2, 4, 8, 16};
  double limit = 0.01;  ///< mean compression above which a run of a map is degraded
};

int command_run(const RunOptions& options);
int command_plan(const PlanOptions& options);
int command_render(const RenderOptions& options);
int command_compare(const CompareOptions& options);
int command_config(const ConfigOptions& options);
int command_info();
int command_bench(const BenchOptions& options);
int command_batch(const BatchOptions& options);
int command_study(const StudyOptions& options);
int command_stability(const StabilityCommandOptions& options);

}  // namespace pbf::inline app_module
