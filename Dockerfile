# The service in a small image: no root, a root file system that may be read-only, one volume for data.
# Other bases (a mirror, a distroless image) go in by --build-arg.
ARG BUILD_BASE=docker.io/library/rust:1.95-bookworm
ARG RUN_BASE=docker.io/library/debian:bookworm-slim

# Compiled on the processor that builds, for the one that the image is for: only files go into the image, so nothing is emulated.
FROM --platform=$BUILDPLATFORM ${BUILD_BASE} AS build
ARG TARGETARCH
WORKDIR /build
COPY . .
ENV CARGO_PROFILE_RELEASE_DEBUG=none CARGO_PROFILE_RELEASE_STRIP=symbols
# With a list of what is in it (CycloneDX).
RUN scripts/deploy/build_for.sh "${TARGETARCH}" /meshmend && python3 scripts/sbom.py > /sbom.cdx.json && mkdir /data

FROM ${RUN_BASE}
COPY --from=build /meshmend /usr/local/bin/meshmend
# Whom to believe when a webhook is called.
COPY --from=build /etc/ssl/certs/ca-certificates.crt /etc/ssl/certs/ca-certificates.crt
COPY --from=build /build/LICENSE-MIT /build/LICENSE-APACHE /sbom.cdx.json /usr/share/doc/meshmend/
# A new volume takes its owner from here.
COPY --from=build --chown=65532:65532 /data /data
USER 65532:65532
VOLUME /data
# All addresses of the container. The admin port stays unpublished; whoever publishes 8080 has to choose between
# MESHMEND_API_KEYS_FILE and MESHMEND_ALLOW_ANONYMOUS=true, without either the service does not start.
ENV MESHMEND_LISTEN=0.0.0.0:8080 MESHMEND_ADMIN_LISTEN=0.0.0.0:8081 MESHMEND_DATA_DIR=/data
EXPOSE 8080
HEALTHCHECK --interval=10s --timeout=3s --start-period=5s CMD ["meshmend", "healthcheck"]
ENTRYPOINT ["meshmend"]
CMD ["serve"]
