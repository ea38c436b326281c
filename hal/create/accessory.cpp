#include "hal/create/accessory.hpp"

#include <vector>

#include "hal/error.hpp"
#include "hal/recording/text.hpp"

namespace st {
namespace {

enum class Has : std::uint8_t { kBoth, kCreate1, kCreate2 };
constexpr int kMostNotes = 16;
constexpr std::size_t kDigits = 4;

struct WordRow {
  const char* word;
  Has has;
  oi::Opcode opcode;
  int arguments;  // kNotes, kText: see below
  int low, high;
  const char* usage;
  const char* help;
};
constexpr int kNotes = -1;  // a number, then pairs of note and length; the command counts them
constexpr int kText = -2;   // characters

constexpr WordRow kWords[] = {
    {"leds", Has::kBoth, oi::kLeds, 3, 0, 255, "leds BITS COLOUR INTENSITY",
     "Create 1: 2 Play, 8 Advance; Create 2: 1 debris, 2 spot, 4 dock, 8 check. Colour 0 green to 255 red"},
    {"song", Has::kBoth, oi::kSong, kNotes, 0, 255, "song NUMBER NOTE LENGTH ...",
     "up to 16 notes, 31-127, each so many 64ths of a second"},
    {"play", Has::kBoth, oi::kPlay, 1, 0, 15, "play NUMBER", "a song that was given before"},
    {"digits", Has::kCreate2, oi::kDigitLedsAscii, kText, 32, 126, "digits TEXT", "up to 4 characters"},
    {"outputs", Has::kCreate1, oi::kDigitalOutputs, 1, 0, 7, "outputs BITS",
     "pins 19, 7 and 20 of the cargo bay"},
    {"low-side", Has::kBoth, oi::kLowSideDrivers, 1, 0, 31, "low-side BITS",
     "Create 1: low-side drivers 0-2; Create 2: side brush 1, vacuum 2, main brush 4"},
    {"duty", Has::kCreate1, oi::kPwmLowSideDrivers, 3, 0, 128, "duty DRIVER2 DRIVER1 DRIVER0",
     "duty cycle of the low-side drivers, 128 is full"},
    {"ir", Has::kCreate1, oi::kSendIr, 1, 0, 255, "ir BYTE",
     "sent by an infrared diode at low-side driver 1"},
};

[[noreturn]] void refuse(std::string_view line, const std::string& why) {
  throw Failure(ExitCode::kBadInput, "`" + std::string(line) + "`: " + why);
}

oi::Command with_text(const WordRow& row, std::string_view text, std::string_view line) {
  oi::Command command = oi::simple(row.opcode);
  if (text.size() > kDigits) refuse(line, "at most 4 characters");
  for (const char c : text) {
    if (c < row.low || c > row.high) refuse(line, "only characters that a keyboard has");
    command.add(c);
  }
  while (command.size < 1 + kDigits) command.add(' ');
  return command;
}

}  // namespace

oi::Command accessory_command(RobotModel model, std::string_view line) {
  std::string_view rest = line;
  const std::string_view word = take_word(rest);
  const Has other = model == RobotModel::kCreate1 ? Has::kCreate2 : Has::kCreate1;
  for (const WordRow& row : kWords) {
    if (word != row.word) continue;
    if (row.has == other) refuse(line, "this model does not have that");
    if (row.arguments == kText) return with_text(row, trimmed(rest), line);
    std::vector<int> numbers;
    for (std::string_view text = take_word(rest); !text.empty(); text = take_word(rest)) {
      int number = 0;
      if (!parse_number(text, number) || number < row.low || number > row.high)
        refuse(line, "numbers from " + std::to_string(row.low) + " to " + std::to_string(row.high) + ": " +
                         row.usage);
      numbers.push_back(number);
    }
    const int count = static_cast<int>(numbers.size());
    const bool notes = row.arguments == kNotes;
    if (notes ? count < 3 || count % 2 == 0 || count > 1 + 2 * kMostNotes : count != row.arguments)
      refuse(line, std::string("is meant to be: ") + row.usage);
    if (notes && numbers[0] > (model == RobotModel::kCreate1 ? 15 : 3))
      refuse(line, "no song of that number: a Create 1 keeps 0-15, a Create 2 0-3");
    oi::Command command = oi::simple(row.opcode);
    for (int i = 0; i < count; ++i) {
      command.add(numbers[static_cast<std::size_t>(i)]);
      if (notes && i == 0) command.add((count - 1) / 2);
    }
    return command;
  }
  refuse(line, "no such word; there are\n" + accessory_help());
}

std::string accessory_help() {
  std::string text;
  for (const WordRow& row : kWords) {
    std::string usage = row.usage;
    usage.resize(32, ' ');
    text += "  " + usage + row.help + "\n";
  }
  return text;
}

}  // namespace st
