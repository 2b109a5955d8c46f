"""Sends bytes without checking them against a protocol."""
import socket


def raw_request(server, text):
    with socket.create_connection((server.host, server.port), timeout=60) as link:
        link.sendall(text)
        link.shutdown(socket.SHUT_WR)
        answer = b""
        while part := link.recv(65536):
            answer += part
        return answer
