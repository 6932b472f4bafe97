// What serves around the core: scene files and scenes from code, result folders, errors, comparison,
// checkpoints, traces, studies.
#pragma once

#include <hompm/hompm.hpp>
#include <hompm/kit/output/run_folder.hpp>
#include <hompm/kit/output/run_report.hpp>
#include <hompm/kit/recorder/checkpoint.hpp>
#include <hompm/kit/recorder/trace.hpp>
#include <hompm/kit/scene_file/reader.hpp>
#include <hompm/kit/study/answers.hpp>
#include <hompm/kit/study/study.hpp>
#include <hompm/kit/verify/compare.hpp>
#include <hompm/kit/verify/exact.hpp>
#include <hompm/kit/verify/judge.hpp>
#include <hompm/kit/verify/made_reference.hpp>
#include <hompm/kit/verify/verdict.hpp>
