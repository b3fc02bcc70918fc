#include "graspfit/base/sha256.hpp"

#include <openssl/evp.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>
#include <new>
#include <span>

#include "files/input_file.hpp"

namespace graspfit::base {

namespace {

using Digest = std::array<unsigned char, EVP_MAX_MD_SIZE>;

/// Two lower-case digits per byte.
std::string hexadecimal(std::span<const unsigned char> bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : bytes) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

}  // namespace

std::string sha256_hex(std::string_view bytes) {
  Digest digest;
  unsigned int size = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1) {
    throw std::bad_alloc();  // Hashing fails only if there is not enough memory.
  }
  return hexadecimal({digest.data(), size});
}

std::string sha256_of_file(const std::filesystem::path& file) {
  std::ifstream stream = internal::open_input_file(file);
  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> hash(EVP_MD_CTX_new(),
                                                                     EVP_MD_CTX_free);
  // Hashing fails only if there is not enough memory.
  if (!hash || EVP_DigestInit_ex(hash.get(), EVP_sha256(), nullptr) != 1) throw std::bad_alloc();
  std::array<char, 1 << 16> block;
  while (stream.read(block.data(), block.size()), stream.gcount() > 0) {
    const auto size = static_cast<std::size_t>(stream.gcount());
    if (EVP_DigestUpdate(hash.get(), block.data(), size) != 1) throw std::bad_alloc();
  }
  if (stream.bad()) internal::fail_to_read(file, std::strerror(errno));
  Digest digest;
  unsigned int size = 0;
  if (EVP_DigestFinal_ex(hash.get(), digest.data(), &size) != 1) throw std::bad_alloc();
  return hexadecimal({digest.data(), size});
}

}  // namespace graspfit::base
