# The command and the Python package, built from this clone:
#   docker build -t prowl . && docker run --rm -v "$PWD:/work" prowl plan hyq/crouch
FROM debian:12-slim AS build
RUN apt-get update && apt-get install -y --no-install-recommends ca-certificates python3 python3-venv
COPY . /prowl
RUN /prowl/scripts/wheel /wheels

FROM debian:12-slim
RUN apt-get update && apt-get install -y --no-install-recommends python3 python3-pip && rm -rf /var/lib/apt/lists/*
COPY --from=build /wheels /wheels
RUN pip install --break-system-packages --no-cache-dir "$(echo /wheels/*.whl)[solvers,figures,formats]"
WORKDIR /work
ENTRYPOINT ["prowl"]
