// SPDX-License-Identifier: Apache-2.0
#include "server/access/certificate.h"

#include "core/base/error.h"
#include "server/access/text_file.h"

#include <array>
#include <ctime>
#include <memory>
#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/x509.h>

namespace fieldcast::access {

namespace {

using SystemTime = std::chrono::system_clock::time_point;

constexpr std::size_t kMaxPemBytes = 4U << 20; // four times a bundle of all public roots

template <class T> using Owned = std::unique_ptr<T, void (*)(T*)>;

/// Reads from `pem` without copying it; `pem` must outlive the result.
Owned<BIO> reader_of(const std::string& pem) {
    ERR_clear_error();
    return {BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())), BIO_free_all};
}

/// Returns no passphrase, so that encrypted keys fail instead of prompting on the terminal.
int no_passphrase(char*, int, int, void*) {
    return 0;
}

Owned<X509> read_certificate(const std::filesystem::path& file) {
    const std::string pem = read_text_file(file, kMaxPemBytes);
    const auto reader = reader_of(pem);
    Owned<X509> certificate(PEM_read_bio_X509(reader.get(), nullptr, no_passphrase, nullptr), X509_free);
    if (certificate == nullptr) {
        throw UserError(file.string() + ": contains no certificate in PEM format (-----BEGIN CERTIFICATE-----)");
    }
    return certificate;
}

Owned<EVP_PKEY> read_key(const std::filesystem::path& file) {
    std::string pem = read_text_file(file, kMaxPemBytes);
    const auto reader = reader_of(pem);
    Owned<EVP_PKEY> key(PEM_read_bio_PrivateKey(reader.get(), nullptr, no_passphrase, nullptr), EVP_PKEY_free);
    OPENSSL_cleanse(pem.data(), pem.size());
    if (key == nullptr) {
        throw UserError(file.string() + ": contains no private key in PEM format, or the key has a passphrase");
    }
    return key;
}

SystemTime to_time(const ASN1_TIME* time) {
    std::tm parts{};
    FC_ASSERT(ASN1_TIME_to_tm(time, &parts) == 1, "a parsed certificate has readable times");
    return std::chrono::system_clock::from_time_t(timegm(&parts));
}

std::string subject_of(const X509& certificate) {
    const Owned<BIO> text(BIO_new(BIO_s_mem()), BIO_free_all);
    X509_NAME_print_ex(text.get(), X509_get_subject_name(&certificate), 0, XN_FLAG_RFC2253);
    char* begin = nullptr;
    const long size = BIO_get_mem_data(text.get(), &begin);
    return {begin, static_cast<std::size_t>(size)};
}

} // namespace

std::string to_text(SystemTime time) {
    const std::time_t seconds = std::chrono::system_clock::to_time_t(time);
    std::tm parts{};
    gmtime_r(&seconds, &parts);
    std::array<char, 32> text{};
    std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
    return text.data();
}

CertificateFacts check_certificate(const CertificateFiles& files, SystemTime now) {
    const auto certificate = read_certificate(files.certificate);
    const auto key = read_key(files.key);
    if (X509_check_private_key(certificate.get(), key.get()) != 1) {
        throw UserError(files.key.string() + ": does not belong to the certificate in " + files.certificate.string());
    }
    const SystemTime begins = to_time(X509_get0_notBefore(certificate.get()));
    const SystemTime expires = to_time(X509_get0_notAfter(certificate.get()));
    if (now >= expires) {
        throw UserError(files.certificate.string() + ": expired at " + to_text(expires) + "; renew it");
    }
    if (now < begins) {
        throw UserError(files.certificate.string() + ": is not valid before " + to_text(begins) +
                        "; is this machine's clock right?");
    }
    if (files.client_ca) {
        read_certificate(*files.client_ca);
    }
    return {.subject = subject_of(*certificate), .expires = expires};
}

} // namespace fieldcast::access
