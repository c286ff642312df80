// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace warren::control {
class Cells;
class Ground;
class LayerFlushed;
class LayerId;
class LoadedLayer;
class MapInfo;
class MapSaved;
class Status;
}  // namespace warren::control

namespace google::protobuf {
class Message;
}

namespace warren {

// Aligned text for people.
std::string table_of(const control::Status& status);
std::string table_of(const control::MapInfo& info);
std::string table_of(const control::Ground& ground);
// Of the cells of which something is known.
std::string table_of(const control::Cells& cells);
std::string sentence_of(const control::MapSaved& saved);
// ORIGIN.NUMBER.INCARNATION, the last in hexadecimal.
std::string text_of(const control::LayerId& id);
std::string sentence_of(const control::LoadedLayer& layer);
std::string sentence_of(const control::LayerFlushed& flushed);
// Every field, by its name in the .proto; 64-bit integers are strings, as protobuf's JSON has them.
std::string json_of(const google::protobuf::Message& message);
// The same in one line.
std::string json_line_of(const google::protobuf::Message& message);

}  // namespace warren
