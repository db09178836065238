// The boards of a session by index, 0 the one whose frame is the world, and changes to them that keep the cameras'
// `board:` right. As in the file, several have names, each camera says which one it sees, and the world's is that of
// the camera worldCamera().
#pragma once

#include "core/pipeline/session/session.h"

#include <string>
#include <vector>

namespace evical {

std::vector<std::string> boardNames(const Session& session);
const Board& boardAt(const Session& session, std::size_t index);
const std::optional<MeasuredLength>& measuredAt(const Session& session, std::size_t index);
// Whether the file has them as `boards:`, by name.
bool hasNamedBoards(const Session& session);
// What the file calls one: "board", or "boards.tags".
std::string boardKey(const Session& session, std::size_t index);

void setBoardAt(std::size_t index, const Board& board, Session& session);
// Its spacing, and how well that is known, follow; without a length the spacing stays, and is as well known as any.
void setMeasuredAt(std::size_t index, const std::optional<MeasuredLength>& measured, Session& session);

// A copy of the one at `like`, under a free name, as the last one. No camera sees it yet.
void addBoard(std::size_t like, Session& session);
// Cameras that saw it see the world's board then. Of the world's the next one takes the place.
// There must be several.
void removeBoard(std::size_t index, Session& session);
// Throws CalibrationError (BadInput, place: the board's key) where it is no name: empty, or another board's or a sensor's.
void renameBoard(std::size_t index, const std::string& name, Session& session);

// After a change of the cameras, of what they see, or of the reference: the board before worldCamera() becomes the
// world's; of several boards a camera that says none sees that one, of one alone no camera needs to say.
void settleBoards(Session& session);

// What a session must fulfil; `place` precedes the key in messages. Throws CalibrationError (BadInput).
void validateBoards(const Session& session, const std::string& place);

// The file's `board:` or `boards:`.
std::string boardsYaml(const Session& session);
// The session's options without what the measure of the world's board says: the file says it there.
CalibrationOptions optionsBesideBoards(const Session& session);

// A further board's spacing_std where it was measured exactly; and what a measure says of it, where there is one.
inline constexpr double kExactSpacing = 1e-7;
std::optional<double> spacingStd(const std::optional<MeasuredLength>& measured);

}  // namespace evical
