// What logs say of IMUs that were calibrated before, for people and programs. Keys are a contract.
#pragma once

#include "core/data/maintenance.h"

#include <cstddef>
#include <string>
#include <vector>

namespace evical {

const char* verdictName(MaintenanceVerdict verdict);   // unchanged, changed, cannot_tell
const char* verdictWords(MaintenanceVerdict verdict);  // "nothing has changed"
const char* sourceName(MaintenanceSource source);      // stops, trajectory, other_imu

std::string maintenanceYaml(const Maintenance& maintenance);
std::string maintenanceJson(const Maintenance& maintenance);
std::string maintenanceTable(const Maintenance& maintenance);

// Stops of all IMUs, a line each; and a track over time, each number with its sigma.
std::string stopsCsv(const Maintenance& maintenance);
std::string trackCsv(const MaintenanceTrack& track);

// Columns of a track that are one quantity: shown beside each other.
struct TrackPart {
  std::string name, unit;          // "rotation", "deg"
  std::vector<std::string> parts;  // "x", "y", "z"; one empty one of a single number
  std::size_t first = 0;           // of the columns
};
std::vector<TrackPart> partsOf(const MaintenanceTrack& track);

}  // namespace evical
