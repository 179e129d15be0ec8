// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/transforms_json/frame_cutter.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace lf {
namespace {

struct Parts {
  std::vector<std::string> frames;
  std::string rest;
  bool is_in_frame = false;
  friend bool operator==(const Parts&, const Parts&) = default;
};

Parts Cut(std::string_view text, size_t piece_size) {
  Parts parts;
  FrameCutter cutter("frames", [&](const std::string& frame) { parts.frames.push_back(frame); });
  for (size_t i = 0; i < text.size(); i += piece_size) cutter.Add(text.substr(i, piece_size));
  parts.rest = cutter.rest();
  parts.is_in_frame = cutter.is_in_frame();
  return parts;
}

Parts Cut(std::string_view text) { return Cut(text, text.size()); }

using Frames = std::vector<std::string>;

TEST(FrameCutter, FramesAreTheObjectsInTheListOfFrames) {
  const Parts parts = Cut(R"({"w": 6, "frames": [{"a": {"b": {}}}, {"c": [[1], [{}]]}], "h": 7})");
  EXPECT_EQ(parts.frames, (Frames{R"({"a": {"b": {}}})", R"({"c": [[1], [{}]]})"}));
  EXPECT_EQ(parts.rest, R"({"w": 6, "frames": [{}, {}], "h": 7})");
}

TEST(FrameCutter, BracketsInStringsAreText) {
  const Frames frames = {R"({"a": "}", "b": "{\"}"})", R"({"c\\": "\\\"}{"})", "{\"\u00e9{\": 1}"};
  const Parts parts = Cut(R"({"]": "[{", "frames": [)" + frames[0] + "," + frames[1] + "," +
                          frames[2] + R"(], "x": "frames"})");
  EXPECT_EQ(parts.frames, frames);
  EXPECT_EQ(parts.rest, R"({"]": "[{", "frames": [{},{},{}], "x": "frames"})");
}

TEST(FrameCutter, WhereThePiecesEndDoesNotMatter) {
  const std::string text =
      "{\"x\\\"\": [{\"y\": \"}\"}], \"frames\" : [ {\"a\\\\\": \"\\\"{\\u00e9\u00e9\"} ,\n{}, 3, "
      "[{}], {\"n\": [{}, 1]}], \"frames\": [{}], \"z\": {\"frames\": [{}]}} {";
  const Parts whole = Cut(text);
  EXPECT_EQ(whole.frames.size(), 4u);
  for (size_t piece_size = 1; piece_size < text.size(); ++piece_size)
    EXPECT_EQ(Cut(text, piece_size), whole) << piece_size;
}

TEST(FrameCutter, TextThatCannotBeJsonIsSeenAtOnce) {
  const auto is_not_json = [](std::string_view text) {
    FrameCutter cutter("frames", [](const std::string&) {});
    cutter.Add(text);
    return cutter.is_not_json();
  };
  using namespace std::string_view_literals;
  for (const std::string_view text : {"\0"sv, "\0\0{}"sv, " \n\0"sv, "{\"frames\": [\0"sv,
                                      "{\"a\": \"\0\""sv, "<html>"sv, "what: []"sv})
    EXPECT_TRUE(is_not_json(text)) << text;
  for (const std::string_view text :
       {""sv, " \r\n\t"sv, "\xEF\xBB\xBF {"sv, "[1]"sv, "-5"sv, "\"a\""sv})
    EXPECT_FALSE(is_not_json(text)) << text;
}

TEST(FrameCutter, AKeyMayBeWrittenWithEscapes) {
  EXPECT_EQ(Cut(R"({"fr\u0061mes": [{}]})").frames.size(), 1u);
  EXPECT_EQ(Cut(R"({"fr\\ames": [{}]})").frames.size(), 0u);
}

TEST(FrameCutter, WhatElseIsCalledFramesIsLeftAlone) {
  for (const std::string text :
       {R"(["frames", [{}]])", R"({"frames": {"a": {}}})", R"({"frames": [[{}], 7]})",
        R"({"x": {"frames": [{}]}})", R"({"x": "frames", "y": [{}]})", R"({"Frames": [{}]})",
        R"({} {"frames": [{}]})", "", "7", "\"frames\"", "}]{"}) {
    const Parts parts = Cut(text);
    EXPECT_TRUE(parts.frames.empty()) << text;
    EXPECT_EQ(parts.rest, text);
  }
}

TEST(FrameCutter, AFrameThatDoesNotEndIsKnown) {
  const std::string text = R"({"frames": [{}, {"a": "}"})";
  EXPECT_FALSE(Cut(text).is_in_frame);
  EXPECT_TRUE(Cut(text.substr(0, text.size() - 1)).is_in_frame);
}

}  // namespace
}  // namespace lf
