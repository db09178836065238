// Boards of a session by index (0: the world frame), and changes that keep the cameras' `board:` consistent.
// Several boards have names, as in the file; each camera names the one that it sees, and the world's board is
// that of worldCamera().
#pragma once

#include "core/pipeline/session/session.h"

#include <string>
#include <vector>

namespace evical {

std::vector<std::string> boardNames(const Session& session);
const Board& boardAt(const Session& session, std::size_t index);
const std::optional<MeasuredLength>& measuredAt(const Session& session, std::size_t index);
// True if the file has them as `boards:`, by name.
bool hasNamedBoards(const Session& session);
// Key of a board in the file: "board", or "boards.tags".
std::string boardKey(const Session& session, std::size_t index);

void setBoardAt(std::size_t index, const Board& board, Session& session);
// Sets the length and the spacing with its sigma. Without a length the spacing stays, with the default sigma.
void setMeasuredAt(std::size_t index, const std::optional<MeasuredLength>& measured, Session& session);

// Appends a copy of the board at `like` with a new name. No camera sees it yet.
void addBoard(std::size_t like, Session& session);
// Assigns the world's board to cameras that saw the removed one. If the world's is removed, the next one
// replaces it. There must be several boards.
void removeBoard(std::size_t index, Session& session);
// Throws CalibrationError (BadInput, place: the board's key) if the name is empty, another board's, or a
// sensor's.
void renameBoard(std::size_t index, const std::string& name, Session& session);

// Restores consistency after a change of cameras, their boards, or the reference: the board of worldCamera()
// becomes the world's. If there are several boards, a camera without a board gets this one; with a single
// board the cameras' entries are removed.
void settleBoards(Session& session);

// Checks the boards; `place` precedes the key in messages. Throws CalibrationError (BadInput).
void validateBoards(const Session& session, const std::string& place);

// `board:` or `boards:` of the file.
std::string boardsYaml(const Session& session);
// The session's options without the sigma that the world board's measured length defines: the file has it
// there.
CalibrationOptions optionsBesideBoards(const Session& session);

// spacing_std of a further board that was measured exactly; and the value from its measured length, if there
// is one.
inline constexpr double kExactSpacing = 1e-7;
std::optional<double> spacingStd(const std::optional<MeasuredLength>& measured);

}  // namespace evical
