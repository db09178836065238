#include "core/pipeline/session/calibration_options.h"

#include "core/base/option_table.h"
#include "core/data/imu_stamps.h"
#include "core/egomotion/egomotion_options.h"
#include "core/frames/frame_options.h"
#include "core/frontend/detection_options.h"
#include "core/frontend/edge_slopes.h"
#include "core/initialisation/initialisation_options.h"
#include "core/intrinsics/intrinsics_options.h"
#include "core/maintenance/maintenance_options.h"
#include "core/optimisation/optimisation_options.h"
#include "core/report/report_options.h"

#include <fmt/format.h>

#include <iterator>
#include <type_traits>

namespace evical {
namespace {

// Options of a group, const if `shared` is const.
template <class Shared>
auto& optionsOf(Shared& shared) {
  if constexpr (std::is_const_v<Shared>)
    return *shared;
  else
    return shared.edit();
}

// One group of the batch's options, const if `options` is const.
template <class Part, class Options>
auto& partOf(Options& options) {
  return static_cast<std::conditional_t<std::is_const_v<Options>, const Part, Part>&>(options);
}

// List of groups: visit(name, condition of the whole group, help, options of the group).
template <class Options, class Visitor>
void forEachGroup(Options& all, Visitor&& visit) {
  using enum Applies;
  auto& front_end = optionsOf(all.front_end);
  auto& batch = optionsOf(all.optimisation);
  visit("stamps", WithImu, "Coarse time stamps of IMUs", optionsOf(all.stamps));
  visit("detection", WithEvents, "General settings of the front end", front_end.detection);
  visit("bursts", WithEvents, "Edge timing: events of one edge at one pixel", front_end.bursts);
  visit("ring_vote", WithRingVotes, "Circle candidates from ring votes", front_end.ring_vote);
  visit("normal_flow", WithNormalFlow, "Circle candidates from normal flow", front_end.normal_flow);
  visit("moving_circle", WithEvents, "Fits of single moving circles", front_end.moving_circle);
  visit("grid", WithEvents, "Assignment of circles to the board", front_end.grid);
  visit("saddle", WithEvents, "Corners of checkerboards and of boards of tags", front_end.saddle);
  visit("tracking", WithEvents, "Joint fits of all circles in a window, and tracking between windows",
        front_end.tracking);
  visit("extent", WithEvents, "Check of the board's number of rows and columns", front_end.extent);
  visit("frames", WithFrames, "Frame cameras: search of images for the board", optionsOf(all.frames));
  visit("blink", WithBlinkingBoard,
        "Blinking boards and event cameras: detection of the blinking, and accumulation of flashes",
        optionsOf(all.blink));
  visit("intrinsics", WithUnknownLens, "Camera intrinsics, if the session gives none",
        optionsOf(all.intrinsics));
  visit("initialisation", Always, "From single views to a first trajectory", optionsOf(all.initialisation));
  visit("optimisation.model", Always,
        "Batch optimisation: estimated quantities and model of the measurements",
        partOf<ModelOptions>(batch));
  visit("optimisation.priors", Always,
        "Batch optimisation: weak priors for quantities that a recording may not determine",
        partOf<PriorOptions>(batch));
  visit("optimisation.solver", Always, "Batch optimisation: solver", partOf<SolverOptions>(batch));
  visit("optimisation.verdict", Always, "Uncertainty, and criteria for a doubtful result",
        partOf<VerdictOptions>(batch));
  visit("report", Always, "Additional analyses for the report", optionsOf(all.report));
  visit("check", InCheck, "Check of an old calibration", optionsOf(all.check));
  visit("edge_slopes", InCheckWithoutBoard, "Check without a board: speed of edges",
        optionsOf(all.edge_slopes));
  visit("egomotion", InCheckWithoutBoard, "Check without a board: the camera's rotation and the gyroscope's",
        optionsOf(all.egomotion));
  visit("maintain", InMaintain, "IMU logs over time: changes since the calibration", optionsOf(all.maintain));
}

template <class Options>
const OptionTable<Options>& tableOf(const Options&) {
  return Options::table();
}

std::vector<std::string> fullNames() {
  std::vector<std::string> names;
  for (const OptionRow& row : optionRows()) names.push_back(row.name);
  return names;
}

// A name has "tuning." if and only if its option is for tuning.
void checkLevel(std::string_view full_name, const OptionRow& row) {
  const std::string name(nameInTables(full_name));
  const bool tuning = row.level == Level::Tuning;
  if (tuning == full_name.starts_with(kTuning)) return;
  if (tuning)
    throw badInput(name, "is a tuning option, which may change with any version",
                   fmt::format("Write {}{}", kTuning, name));
  throw badInput(std::string(full_name), "is not a tuning option", "Write " + name);
}

}  // namespace

CalibrationOptions::CalibrationOptions() = default;

bool CalibrationOptions::operator==(const CalibrationOptions&) const = default;

std::vector<OptionSection> optionSections(const CalibrationOptions& options) {
  std::vector<OptionSection> sections;
  forEachGroup(options, [&](const char* group, Applies applies, const char* help, const auto& group_options) {
    sections.push_back({group, help, tableOf(group_options).rows(group_options, group)});
    for (OptionRow& row : sections.back().rows) row.applies.insert(row.applies.begin(), applies);
  });
  return sections;
}

void setOption(CalibrationOptions& options, std::string_view full_name, std::string_view value) {
  const std::string_view in_tables = nameInTables(full_name);
  const std::size_t dot = in_tables.rfind('.');
  if (dot == std::string_view::npos)
    throw badInput(std::string(full_name), "is not the name of an option",
                   "Options are named group.option; " + nameAdvice(full_name, fullNames()));
  const std::string group(in_tables.substr(0, dot));
  const std::string_view name = in_tables.substr(dot + 1);
  bool found = false;
  forEachGroup(options, [&](const std::string& known, Applies, const char*, auto& group_options) {
    const OptionRow* const row = tableOf(group_options).find(name);
    const bool part_of_it = known.starts_with(group + ".") && row;
    if (found || (known != group && !part_of_it)) return;
    found = true;
    if (row) checkLevel(full_name, *row);
    tableOf(group_options).set(group_options, known, name, value);
  });
  if (!found) throw badInput(std::string(full_name), "no such option", nameAdvice(full_name, fullNames()));
}

void validate(const CalibrationOptions& options) {
  forEachGroup(options, [](const char* group, Applies, const char*, const auto& group_options) {
    tableOf(group_options).checkOrder(group_options, group);
  });
}

std::vector<OptionRow> optionRows(const CalibrationOptions& options) {
  std::vector<OptionRow> rows;
  for (OptionSection& section : optionSections(options))
    rows.insert(rows.end(), std::make_move_iterator(section.rows.begin()),
                std::make_move_iterator(section.rows.end()));
  return rows;
}

std::vector<OptionRow> documentedOptions(const CalibrationOptions& options) {
  std::vector<OptionRow> rows = optionRows(options);
  std::erase_if(rows, [](const OptionRow& row) { return row.level == Level::Tuning; });
  return rows;
}

std::vector<OptionRow> differingOptions(const CalibrationOptions& options) {
  std::vector<OptionRow> rows = optionRows(options);
  std::erase_if(rows, [](const OptionRow& row) { return row.value == row.default_value; });
  return rows;
}

namespace {

constexpr std::tuple kCheckFields{
    Field{"stability_rotation_deg", &CheckOptions::stability_rotation_deg, 0.02, within(0.0, 90.0), "deg",
          "Rotation changes up to this size are not reported as a change.", Level::Public},
    Field{"stability_translation_mm", &CheckOptions::stability_translation_mm, 0.3, within(0.0, 1e4), "mm",
          "Translation changes up to this size are not reported as a change.", Level::Public},
    Field{"stability_time_offset_ms", &CheckOptions::stability_time_offset_ms, 0.05, within(0.0, 1e4), "ms",
          "Changes of time offsets and accelerometer delays up to this size are not reported; includes the "
          "effect of light on pixel delays.",
          Level::Public},
    Field{"stability_lens_px", &CheckOptions::stability_lens_px, 0.1, within(0.0, 1000.0), "px",
          "Lens changes up to this size, RMS over the image, are not reported as a change.", Level::Public},
    Field{"stability_imu_scale", &CheckOptions::stability_imu_scale, 0.001, within(0.0, 1.0), "",
          "Changes of IMU scale factors and misalignments up to this size are not reported; they change with "
          "temperature.",
          Level::Public},
    Field{"matters_rotation_deg", &CheckOptions::matters_rotation_deg, 0.25, within(1e-4, 90.0), "deg",
          "Required detectability: the verdict is unchanged only if a rotation change of this size would "
          "have been detected.",
          Level::Expert},
    Field{"matters_translation_mm", &CheckOptions::matters_translation_mm, 6.0, within(1e-3, 1e4), "mm",
          "Required detectability of translation changes.", Level::Expert},
    Field{"matters_time_offset_ms", &CheckOptions::matters_time_offset_ms, 0.5, within(1e-4, 1e4), "ms",
          "Required detectability of time offset changes.", Level::Expert},
    Field{"matters_lens_px", &CheckOptions::matters_lens_px, 1.0, within(1e-3, 1000.0), "px",
          "Required detectability of lens changes, RMS over the image.", Level::Expert},
    Field{"false_alarms", &CheckOptions::false_alarms, 0.01, within(1e-9, 0.5), "",
          "Probability that an unchanged calibration is reported as changed, over all quantities together.",
          Level::Expert},
    Switch{"no_board", &CheckOptions::no_board, false,
           "Check without a board: only rotations and time offsets of event cameras are checked.",
           Level::Public},
    Field{"without_board_rotation_deg", &CheckOptions::without_board_rotation_deg, 1.5, within(1e-4, 90.0),
          "deg", "Required detectability of rotation changes in a check without a board.", Level::Expert,
          Applies::InCheckWithoutBoard},
    Field{"without_board_time_offset_ms", &CheckOptions::without_board_time_offset_ms, 3.0, within(1e-4, 1e4),
          "ms", "Required detectability of time offset changes in a check without a board.", Level::Expert,
          Applies::InCheckWithoutBoard},
    Field{"without_board_min_rotation_deg", &CheckOptions::without_board_min_rotation_deg, 0.2,
          within(0.0, 90.0), "deg",
          "Smallest rotation change that a check without a board reports: scenes and motion cause such "
          "errors."},
    Field{"without_board_min_time_offset_ms", &CheckOptions::without_board_min_time_offset_ms, 0.5,
          within(0.0, 1e4), "ms", "Smallest time offset change that a check without a board reports."},
    Field{"without_board_misfit", &CheckOptions::without_board_misfit, 0.5, within(0.01, 10.0), "",
          "Largest residual share of the angular rates without a board; above it, camera and IMU are not on "
          "one rig."},
    Field{"without_board_scale", &CheckOptions::without_board_scale, 0.1, within(0.001, 10.0), "",
          "Largest relative error of rotations without a board; above it, the lens is another one."},
    Field{"min_board_share", &CheckOptions::min_board_share, 0.02, within(0.0, 1.0), "",
          "Smallest share of event windows with the board; below it, the check does not use the board."},
    Field{"copy_sigmas", &CheckOptions::copy_sigmas, 0.2, within(0.0, 1.0), "sigma",
          "Largest change in a copy of the old recording; one of 6 s gave 0.07."}};
constexpr auto kCheckDefaults = defaultsOf<CheckOptions, kCheckFields>();

}  // namespace

CheckOptions::CheckOptions() : CheckOptions(kCheckDefaults) {}

const OptionTable<CheckOptions>& CheckOptions::table() {
  static const OptionTable<CheckOptions> table(kCheckFields);
  return table;
}

}  // namespace evical
