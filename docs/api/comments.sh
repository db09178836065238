#!/bin/sh
# Doxygen's input filter: our comments are plain `//`, which it would skip. Those above a declaration become `///`, those behind a member
# `///<`, and the first one is the file's. What is indented further than the text is a formula.
awk '
  # Names of frames and units, and formulas, are no commands.
  function plain(text) { gsub(/\\/, "\\\\", text); gsub(/@/, "\\@", text); gsub(/</, "\\&lt;", text); gsub(/>/, "\\&gt;", text)
                         gsub(/#/, "\\#", text); return text }
  NR == 1 && /^\/\// { print "/// @file" }
  match($0, /^ *\/\/ ?/) && !/^ *\/\/\// {
    marker = substr($0, 1, RLENGTH); sub(/\/\/ ?$/, "///", marker)
    print marker " " plain(substr($0, RLENGTH + 1)); next
  }
  match($0, /[;,{(] +\/\/ /) && !/^ *\/\// {
    print substr($0, 1, RSTART) " ///< " plain(substr($0, RSTART + RLENGTH)); next
  }
  { print }' "$1"
