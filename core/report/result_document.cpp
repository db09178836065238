#include "core/report/result_document.h"

namespace evical {
namespace {

template <class Item>
Item itemOr(const std::vector<Item>& items, std::size_t index) {
  return index < items.size() ? items[index] : Item{};
}

}  // namespace

ResultDocument documentOf(const CalibrationInput& input, const CalibrationResult& result,
                          ProgramInfo program) {
  ResultDocument document;
  document.status = result.status;
  document.reason = result.reason;
  document.reference = input.imus.at(input.reference_imu).name;
  for (std::size_t i = 0; i < input.cameras.size(); ++i)
    document.cameras.push_back({input.cameras[i].name, result.state.cameras.at(i),
                                itemOr(result.uncertainty.cameras, i), input.cameras[i].intrinsics,
                                itemOr(result.cameras, i)});
  for (std::size_t i = 0; i < input.imus.size(); ++i)
    document.imus.push_back({input.imus[i].name, result.state.imus.at(i), itemOr(result.uncertainty.imus, i),
                             itemOr(result.imus, i)});
  document.gravity_in_world_m_s2 = result.state.gravity_in_world_m_s2;
  document.uncertainty = result.uncertainty;
  document.uncertainty.cameras.clear();
  document.uncertainty.imus.clear();
  document.notes = result.notes;
  document.timing = result.timing;
  document.memory_peak_mb = result.memory_peak_mb;
  document.program = std::move(program);
  return document;
}

ResultDocument failedDocument(std::string reason, ProgramInfo program) {
  ResultDocument document;
  document.status = CalibrationStatus::Failed;
  document.reason = std::move(reason);
  document.program = std::move(program);
  return document;
}

const char* statusName(CalibrationStatus status) {
  switch (status) {
    case CalibrationStatus::Ok:
      return "ok";
    case CalibrationStatus::Doubtful:
      return "doubtful";
    case CalibrationStatus::Failed:
      break;
  }
  return "failed";
}

}  // namespace evical
