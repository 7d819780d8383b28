#include "app/help.h"

#include "lib/solver/diagnostics.h"

namespace pbf::inline app_module::help {

const char* const kExitCodes =
    "Exit codes:\n"
    "  0   done\n"
    "  1   internal error\n"
    "  2   bad command line or scene\n"
    "  3   run stopped by the stability guard\n"
    "  4   backend, device or memory not available\n"
    "  5   file cannot be read or written (disk full)\n"
    "  6   compare found a difference, batch has failed runs, a suite found a failure, a run\n"
    "      with --strict warned\n"
    "  75  stopped early by a signal or the wall-time limit, after saving\n\n"
    "Example: pbf run configs/dam_break.yaml --out out/dam_break";

std::string diagnostics_text() {
  return "Diagnostics (formulas: lib/solver/DIAGNOSTICS.md; c = max(rho/rho0 - 1, 0) of a "
         "particle, "
         "walls\n"
         "included; H0 = volume of the fluid / area of the floor):\n" +
         diagnostics_help();
}

const char* const kPlanHelp =
    "The time per update is an estimate from what `pbf bench --calibrate` has stored on this\n"
    "machine; without it none is printed.\n"
    "Example:\n  pbf plan configs/dam_break.yaml --set fluid.spacing=0.005";

const char* const kRenderHelp =
    "Example:\n"
    "  pbf render out/dam_break/run.vtkhdf --frames 0:-1:5 --size 1920x1080 --color density \\\n"
    "      --camera 'position=3,-4,2;fov=30'";

const char* const kCompareHelp =
    "With --between: one update from one state, stage by stage; then how far particles drift\n"
    "apart; then statistics that chaos leaves alone. Each against what rounding at random does\n"
    "to references in double on the CPU (so allow for their time: the number of --members).\n"
    "Of two run files: the scenes' physics; status, end, frames, fields and rows of the log, "
    "where\n"
    "what only one file holds is a difference; particles, where the same bits are promised; the\n"
    "particles of every frame as two samples. There, values up to 16 roundings apart are equal:\n"
    "of the coarser of computed and stored precision, relative to the box for positions, to the\n"
    "box over a step for velocities, to 1 + box/h for densities. A difference of all the fluid\n"
    "at once, after chaos has grown, may still be one of rounding: --between tells.\n"
    "Exit code 0 when nothing differs by more, 6 when something does.\n"
    "Examples:\n"
    "  pbf compare configs/minimal.yaml --between cpu:double,cuda:float --report compare.html\n"
    "  pbf compare configs/minimal.yaml --between cpu:float@1,cpu:float@2\n"
    "  pbf compare out/a/run.vtkhdf out/b/run.vtkhdf";

const char* const kBenchHelp =
    "Two lines per case: from the first updates on (start), and after the warm-up (late).\n"
    "Stage times on cuda are those of one update in 64 to 1024, timed by\n"
    "device events, and share the time of all. With time.adaptive an update is one step here.\n"
    "Examples:\n"
    "  pbf bench --n 10000,100000 --backend cpu --threads 1,2 --precision float,double \\\n"
    "      --csv bench.csv\n"
    "  pbf bench --calibrate --n 10000,100000 --warmup 100 --updates 20";

const char* const kBatchHelp =
    "Every run is `pbf run --resume` in a folder of its own: what is finished (DONE is there, and\n"
    "run.vtkhdf is whole, of this scene, up to its end; --collect looks too) is left alone,\n"
    "what was stopped or killed goes on, so the same command can be given again until all is\n"
    "done. OUT/summary.csv has a row per run: why it ended, its last measures. SIGTERM, SIGINT\n"
    "and --max-walltime save all runs.\n"
    "Exit code 0 when all are finished, 75 when some are to go on, 6 when some failed.\n"
    "Examples:\n"
    "  pbf batch configs/dam_break.yaml --grid solver.iterations=2,4,8 \\\n"
    "      --grid time.step=0.002,0.001 --jobs 2\n"
    "  pbf batch scenes/ --out out/scenes --set checkpoint.every=60\n"
    "  pbf batch scenes/ --out out/scenes --slurm > job.sh; sbatch job.sh";

const char* const kStabilityHelp =
    "Exit code 6 when a case is not as it must be.\n"
    "Examples:\n"
    "  pbf stability --reduced --csv stability.csv\n"
    "  pbf stability stiffness column_48 --precision double\n"
    "  pbf stability --map time.step,gravity --x 0.001:0.05:6 --y 1,10,100 --csv map.csv\n"
    "  python -m pbf_tools plot-map map.csv -o map.png";

const char* const kRunHelp =
    "Examples:\n"
    "  pbf run configs/dam_break.yaml\n"
    "  pbf run configs/dam_break.yaml --out out/fine --set fluid.spacing=0.01 --threads 8\n"
    "  pbf run configs/dam_break.yaml --set checkpoint.every=60 --resume\n"
    "  pbf run out/fine/run.vtkhdf --out out/again\n"
    "SIGTERM and SIGINT finish the update, save a checkpoint and exit 75, as --max-walltime\n"
    "does; a second one ends at once. SIGUSR1 saves a checkpoint and goes on. With\n"
    "time.adaptive and the guard, checkpoints are of the last measure or frame, and no run\n"
    "ends before its first.\n"
    "Exit codes are listed in pbf --help.\n\n";

const char* const kStudyHelp =
    "A study file:\n"
    "  scene: ../dam_break.yaml           # from this file's folder\n"
    "  set: {time.end: 0.5, render: off}  # keys of the scene, for every run\n"
    "  variants:                          # curves; each a set of keys\n"
    "    - {name: paper, set: {solver.kernels: paper}}\n"
    "    - {name: consistent}\n"
    "  grid:                              # every combination of these entries;\n"
    "    - {solver.iterations: [1, 4]}    # keys of one entry vary together\n"
    "    - {time.step: [0.002, 0.001], measure_every: [10, 20]}\n"
    "  error: compression_mean            # set against the run time [default]\n"
    "  targets: [0.01, 0.001]             # of the error [default]\n"
    "  from: 0.1                          # s, measures count from here [0]\n"
    "  repeats: 3                         # of the timing [default]\n"
    "  clock: wall                        # or cpu, of all threads: on busy machines\n"
    "  energy_limit: 0.03                 # larger energy_rise: no verdict [default]\n"
    "  projection: [0.2, 0.4]             # s, compare with the exact projection\n"
    "  reference: {solver.iterations: 64} # keys; reference_distance to this run\n"
    "  front: {axis: x, length: 0.1, factor: 2, data: [front.csv]}\n"
    "                                     # T = t sqrt(factor g/length), Z = x/length\n"
    "Results are kept per run in OUT/members: the same command goes on where a killed\n"
    "one ended, and runs only what is new. OUT/study.csv and study.json hold the table:\n"
    "compression and pool measures are means over time (compression_rms: root of the\n"
    "mean square, maxima: the largest) from `from` on, seconds_median those of all\n"
    "updates. * in the table on the terminal: no other run is both faster and better.\n"
    "\n";

const char* const kStudyMeasures =
    "  projection_mean, _rms, _max  distance of one update from the exact projection [spacings]\n"
    "  reference_distance     RMS distance of the centres of mass / (volume)^(1/3) [1]\n"
    "  front_rms_<data>       RMS of Z - Z published [1]; all fronts in OUT/front.csv\n\n"
    "Example:\n"
    "  pbf study configs/study/dam_break.yaml --out out/study --set threads=2";

}  // namespace pbf::inline app_module::help
