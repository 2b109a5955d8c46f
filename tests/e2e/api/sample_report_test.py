"""The sample of a condition report in the guide has the texts that the server writes today."""
import pytest
from support.sample_report import docx_texts, kept, make_site, pdf_words, report
from support.strata_server import StrataServer


@pytest.fixture(scope="module")
def server():
    with StrataServer(demo=True) as started:
        make_site(started)
        yield started


def test_the_docx_of_the_guide_is_what_the_server_writes(server):
    now = docx_texts(report(server, "docx"))
    assert docx_texts(kept("docx")) == now, "scripts/sample_report writes the sample again"


def test_the_pdf_of_the_guide_has_the_same_words():
    words = [word for text in docx_texts(kept("docx")) for word in text.split()]
    assert words and set(words) <= set(pdf_words(kept("pdf")))
