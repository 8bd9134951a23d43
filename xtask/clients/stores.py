"""Object stores on loopback, each a program of others, with a bucket `land` and its account in the environment."""

import logging
import os
import socket
import subprocess
import time

from orogen import NODE_BIN


class S3:
    """The store of moto."""

    url = "s3://land"

    def __init__(self):
        import boto3
        from moto.server import ThreadedMotoServer

        # A line for each request.
        logging.getLogger("werkzeug").setLevel(logging.ERROR)
        self.server = ThreadedMotoServer(ip_address="127.0.0.1", port=0)
        self.server.start()
        host, port = self.server.get_host_and_port()
        os.environ.update(
            AWS_ENDPOINT_URL=f"http://{host}:{port}",
            AWS_ALLOW_HTTP="true",
            AWS_REGION="us-east-1",
            AWS_ACCESS_KEY_ID="somebody",
            AWS_SECRET_ACCESS_KEY="secret",
        )
        self.client = boto3.client("s3", region_name="us-east-1", endpoint_url=f"http://{host}:{port}")
        self.client.create_bucket(Bucket="land")

    def names(self, prefix):
        pages = self.client.get_paginator("list_objects_v2").paginate(Bucket="land", Prefix=prefix)
        return [entry["Key"] for page in pages for entry in page.get("Contents", [])]

    def read(self, name):
        return self.client.get_object(Bucket="land", Key=name)["Body"].read()

    def write(self, name, path):
        self.client.upload_file(str(path), "land", name)

    def stop(self):
        self.server.stop()


class Azure:
    """Azurite, the store of Azure's developers."""

    url = "az://land"

    # The account and key that every Azurite has.
    account = "devstoreaccount1"
    key = "Eby8vdM02xNOcqFlqUwJPLlmEtlCDXJ1OUzFT50uSRZ6IFsuFq2UVErCz4I6tq/K1SZFPTOtr/KBHBeksoGMGw=="

    def __init__(self):
        from azure.core.exceptions import ServiceRequestError
        from azure.storage.blob import BlobServiceClient

        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        line = [NODE_BIN / "azurite-blob", "--blobHost", "127.0.0.1", "--blobPort", str(port), "--inMemoryPersistence"]
        line += ["--skipApiVersionCheck", "--disableTelemetry", "--silent"]
        self.server = subprocess.Popen(line, stdout=subprocess.DEVNULL)
        endpoint = f"http://127.0.0.1:{port}/{self.account}"
        os.environ.update(
            AZURE_STORAGE_ENDPOINT=endpoint,
            AZURE_ALLOW_HTTP="true",
            AZURE_STORAGE_ACCOUNT_NAME=self.account,
            AZURE_STORAGE_ACCOUNT_KEY=self.key,
        )
        service = BlobServiceClient(endpoint, credential=self.key, retry_total=0)
        while True:
            try:
                self.client = service.create_container("land")
                break
            except ServiceRequestError:
                if self.server.poll() is not None:
                    raise
                time.sleep(0.1)

    def names(self, prefix):
        return [blob.name for blob in self.client.list_blobs(name_starts_with=prefix)]

    def read(self, name):
        return self.client.download_blob(name).readall()

    def write(self, name, path):
        with open(path, "rb") as file:
            self.client.upload_blob(name, file)

    def stop(self):
        self.server.terminate()
        self.server.wait()
