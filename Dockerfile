# tcsim in a container: `docker build -t tcs .`, then, in a folder with a scenario,
#   docker run --rm -v "$PWD:/work" --user "$(id -u):$(id -g)" tcs run --accounting fixed
# It needs no rights. With --ulimit rtprio=14 --cap-add SYS_PTRACE runs take less time (`tcsim doctor`).
FROM debian:trixie AS build
RUN apt-get update && apt-get install -y --no-install-recommends ca-certificates git
COPY . /src
RUN cd /src && ./dev package && cp build/package/tcsim_*.deb /tcsim.deb

FROM debian:trixie
COPY --from=build /tcsim.deb /tmp/tcsim.deb
RUN apt-get update && apt-get install -y --no-install-recommends /tmp/tcsim.deb python3 && \
    rm -rf /tmp/tcsim.deb /var/lib/apt/lists/*
WORKDIR /work
ENTRYPOINT ["tcsim"]
CMD ["--help"]
