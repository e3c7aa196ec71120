// SPDX-License-Identifier: Apache-2.0
#include "certificate_authority.h"

#include <gtest/gtest.h>
#include <openssl/bio.h>
#include <openssl/ec.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>

namespace fieldcast::test {

struct CertificateAuthority::Pair {
    EVP_PKEY* key = nullptr;
    X509* certificate = nullptr;

    Pair() = default;
    Pair(const Pair&) = delete;
    Pair& operator=(const Pair&) = delete;
    ~Pair() {
        X509_free(certificate);
        EVP_PKEY_free(key);
    }
};

namespace {

/// What `write` puts into a BIO.
template <class Write> std::string written(const Write& write) {
    BIO* const bio = BIO_new(BIO_s_mem());
    write(bio);
    char* begin = nullptr;
    const long size = BIO_get_mem_data(bio, &begin);
    std::string text(begin, static_cast<std::size_t>(size));
    BIO_free(bio);
    return text;
}

std::string pem_of(X509* certificate) {
    return written([&](BIO* bio) { PEM_write_bio_X509(bio, certificate); });
}

std::string pem_of(EVP_PKEY* key) {
    return written([&](BIO* bio) { PEM_write_bio_PrivateKey(bio, key, nullptr, nullptr, 0, nullptr, nullptr); });
}

void add_extension(X509* certificate, X509* issuer, int nid, const std::string& value) {
    X509V3_CTX context;
    X509V3_set_ctx_nodb(&context);
    X509V3_set_ctx(&context, issuer, certificate, nullptr, nullptr, 0);
    X509_EXTENSION* const extension = X509V3_EXT_conf_nid(nullptr, &context, nid, value.c_str());
    EXPECT_NE(extension, nullptr) << value;
    X509_add_ext(certificate, extension, -1);
    X509_EXTENSION_free(extension);
}

/// Version, serial number, times, subject and key; neither issuer nor signature.
X509* unsigned_certificate(const CertificateOptions& options, EVP_PKEY* key) {
    X509* const certificate = X509_new();
    X509_set_version(certificate, 2); // which means version 3
    std::uint32_t serial = 0;
    RAND_bytes(reinterpret_cast<unsigned char*>(&serial), sizeof serial);
    ASN1_INTEGER_set(X509_get_serialNumber(certificate), static_cast<long>(serial >> 1U) + 1);
    X509_gmtime_adj(X509_getm_notBefore(certificate), static_cast<long>(options.begins.count()));
    X509_gmtime_adj(X509_getm_notAfter(certificate), static_cast<long>(options.ends.count()));
    X509_NAME* const name = X509_get_subject_name(certificate);
    X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_UTF8, reinterpret_cast<const unsigned char*>(options.subject.c_str()),
                               -1, -1, 0);
    X509_set_pubkey(certificate, key);
    return certificate;
}

} // namespace

CertificateAuthority::CertificateAuthority() : pair_(std::make_unique<Pair>()) {
    pair_->key = EVP_EC_gen("P-256");
    pair_->certificate = unsigned_certificate({.subject = "Test authority"}, pair_->key);
    X509* const own = pair_->certificate;
    X509_set_issuer_name(own, X509_get_subject_name(own));
    add_extension(own, own, NID_basic_constraints, "critical,CA:TRUE");
    add_extension(own, own, NID_key_usage, "critical,keyCertSign");
    add_extension(own, own, NID_subject_key_identifier, "hash");
    X509_sign(own, pair_->key, EVP_sha256());
}

CertificateAuthority::~CertificateAuthority() = default;

std::string CertificateAuthority::certificate() const {
    return pem_of(pair_->certificate);
}

Issued CertificateAuthority::issue(const CertificateOptions& options) const {
    Pair issued;
    issued.key = EVP_EC_gen("P-256");
    issued.certificate = unsigned_certificate(options, issued.key);
    X509_set_issuer_name(issued.certificate, X509_get_subject_name(pair_->certificate));
    add_extension(issued.certificate, pair_->certificate, NID_subject_alt_name, options.names);
    X509_sign(issued.certificate, pair_->key, EVP_sha256());
    return {.certificate = pem_of(issued.certificate), .key = pem_of(issued.key)};
}

} // namespace fieldcast::test
