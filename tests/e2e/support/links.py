"""Connections that a test can cut: between a node and its PostgreSQL, and between browsers and a
node."""
import os
import socket
import threading


class Link:
    """A TCP address on the loopback interface that leads to the address of another socket.

    `cut` has the effect of an unplugged cable: no byte passes in either direction, also on new
    connections, and nothing is closed. `mend` delivers the held bytes in their order, so the target
    may receive a request long after the sender has given it up."""

    def __init__(self, target):
        """`target`: a path of a Unix socket, or a host and a port."""
        self.target = target
        self.family = socket.AF_UNIX if isinstance(target, str) else socket.AF_INET
        self.flows = threading.Event()
        self.flows.set()
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        threading.Thread(target=self._accept, daemon=True).start()

    def cut(self):
        self.flows.clear()

    def mend(self):
        self.flows.set()

    def close(self):
        """Accepts no more connections. Open connections end with one of their two ends."""
        self.mend()
        # wakes the thread, which would otherwise keep the socket open
        self.listener.shutdown(socket.SHUT_RDWR)
        self.listener.close()

    def _accept(self):
        while True:
            try:
                client, _ = self.listener.accept()
            except OSError:
                return  # closed
            threading.Thread(target=self._serve, args=(client,), daemon=True).start()

    def _serve(self, client):
        self.flows.wait()
        with client, socket.socket(self.family) as server:
            try:
                server.connect(self.target)
                client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                if self.family == socket.AF_INET:
                    server.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            except OSError:
                return  # the target is down, or the client is gone
            back = threading.Thread(target=self._pass_on, args=(server, client), daemon=True)
            back.start()
            self._pass_on(client, server)
            back.join()

    def _pass_on(self, source, target):
        try:
            while part := source.recv(1 << 16):
                self.flows.wait()
                target.sendall(part)
            self.flows.wait()
        except OSError:
            pass  # one of the two ends is gone
        for end in (source, target):
            try:
                end.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass  # already closed


class DatabaseLink(Link):
    """A link to the Unix socket of a PostgreSQL."""

    def __init__(self, postgres):
        super().__init__(os.path.join(postgres.folder, ".s.PGSQL.5432"))

    @property
    def dsn(self):
        return f"host=127.0.0.1 port={self.port} user=strata dbname=strata sslmode=disable"
