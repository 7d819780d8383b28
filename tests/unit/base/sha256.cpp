// SHA-256 against the examples of its standard and of NIST's validation program.
#include "lib/base/sha256.h"

#include "tests/support/catch.h"

using pbf::Sha256;
using pbf::sha256;

TEST_CASE("SHA-256 gives the digests of FIPS 180-4 and of NIST's examples") {
  CHECK(sha256("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(sha256("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
        "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  CHECK(sha256("abcdefghbcdefghicdefghijdefghijkefghijklfghijklmghijklmnhijklmnoijklmnopjklmnopq"
               "klmnopqrlmnopqrsmnopqrstnopqrstu") ==
        "cf5b16a778af8380036ce59e7b0492370b249b11e8f07a51afac45037afee9d1");
  CHECK(sha256(std::string(1000000, 'a')) ==
        "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  // Byte-oriented messages of 8 and 64 bits (SHA256ShortMsg), and bytes above 127.
  CHECK(sha256("\xd3") == "28969cdfa74a12c82f3bad960b0b000aca2ac329deea5c2328ebc6f2ba9802c1");
  CHECK(sha256("\x57\x38\xc9\x29\xc4\xf4\xcc\xb6") ==
        "963bb88f27f512777aab6c8b1a02c70ec0ad651d428f870036e1917120fb48bf");
}

TEST_CASE("SHA-256 does not depend on the pieces in which bytes come") {
  std::string text;
  for (int k = 0; k < 1000; ++k) text += static_cast<char>(k * 7);
  for (std::size_t length = 0; length <= 200; ++length) {
    const std::string part = text.substr(0, length);
    Sha256 bytes, halves;
    for (const char c : part) bytes.add({&c, 1});
    halves.add(part.substr(0, length / 3));
    halves.add("");
    halves.add(part.substr(length / 3));
    REQUIRE(bytes.text() == sha256(part));
    REQUIRE(halves.text() == sha256(part));
  }
}
